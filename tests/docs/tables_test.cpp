// Tables of figures in docs/ are those that bench_tables makes of the results beside them, cell for cell.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "bench/result_tables.hpp"
#include "docs/documents.hpp"
#include "support/temp_folder.hpp"

namespace pfvox::test {
namespace {

using bench::TabledDocument;
using bench::withTables;
using ::testing::HasSubstr;

/// Results that wait for a run on the card of their tables. Whoever adds one takes it off.
const std::set<std::string> kNotMeasuredYet{"trace.jsonl"};

TEST(DocumentTables, AreThoseOfTheirResults) {
    std::set<std::string> absent;
    std::size_t marked = 0;
    for (const auto& entry : std::filesystem::directory_iterator(kProjectDir / "docs")) {
        if (entry.path().extension() != ".md") continue;
        const std::string text = readText(entry.path());
        const TabledDocument made = withTables(text, kProjectDir / "docs/results");
        EXPECT_EQ(made.text, text)
            << entry.path() << " has a table that is not that of its results: run bench_tables docs/*.md";
        absent.insert(made.absent.begin(), made.absent.end());
        marked += made.tables + made.absent.size();
    }
    EXPECT_EQ(absent, kNotMeasuredYet);
    EXPECT_GE(marked, 7u) << "the documents lost their marks";
}

constexpr const char* kRow =
    R"({"scene":"hall","profile":"default","fileBytes":12345678,"bake":{"totalMs":17400.0,"meanSamples":256.0},"verify":{"camera":"door",)"
    R"("tierFractions":{"texels":0.9991},"reference":{"samples":16384,"isCertain":false},"all":{"relativeRmse":0.138,)"
    R"("relativeTrimmedRmse":0.071,"relativeNoise":0.049,"relativeError":0.13},"byTier":{"texels":{"relativeError":0.129}},)"
    R"("psnrDecibel":30.6,"meanFlip":0.052,"noiseFlip":0.036}})";

TEST(DocumentTables, AWrongCellIsSeenAndMended) {
    const TempFolder folder;
    writeText(folder / "verify.jsonl", std::string(kRow) + "\n");
    const std::string begin = "text\n<!-- table verify of verify.jsonl -->\n";
    const std::string end = "<!-- end of table -->\nmore\n";
    const TabledDocument made = withTables(begin + "| old |\n" + end, folder.path());
    EXPECT_EQ(made.tables, 1u);
    EXPECT_THAT(
        made.text,
        HasSubstr("\n| hall, door | default | 256 | 17.4 | 12.3 | 99.9 % | 13.8 % | 7.1 % | 16,384 | 4.9 % | "
                  "13.0 % ? | 12.9 % | 30.6 | 0.052 | 0.036 |\n" +
                  end));
    EXPECT_EQ(withTables(made.text, folder.path()).text, made.text);
    std::string wrong = made.text;
    wrong.replace(wrong.find("13.8 %"), 6, "12.8 %");
    EXPECT_EQ(withTables(wrong, folder.path()).text, made.text);
}

TEST(DocumentTables, RaysAreThoseOfBothPrograms) {
    const TempFolder folder;
    writeText(folder / "trace.jsonl",
              "{\"scene\":\"sphere\",\"voxels\":2000000,\"instances\":1,\"bytes\":1000000,\"octreeBytes\":3,"
              "\"buildMs\":7.6}\n"
              "{\"scene\":\"sphere\",\"camera\":\"near\",\"rays\":\"primary\",\"way\":\"geometry\",\"Mrays/"
              "s\":7770.4,\"stepsPerRay\":14.93}\n"
              "{\"scene\":\"sphere\",\"camera\":\"near\",\"rays\":\"primary\",\"way\":\"scene\",\"Mrays/"
              "s\":7052,\"stepsPerRay\":15}\n");
    writeText(folder / "anchor.jsonl",
              "{\"scene\":\"sphere\",\"camera\":\"near\",\"rays\":\"primary\",\"way\":\"plain\",\"Mrays/"
              "s\":3885.2}\n");
    const auto made = [&](const std::string& name) {
        return withTables(
                   "\n<!-- table " + name + " of trace.jsonl anchor.jsonl -->\n<!-- end of table -->\n",
                   folder.path())
            .text;
    };
    EXPECT_THAT(made("trace-primary"),
                HasSubstr("\n| sphere near | 7.77 | 7.05 | 3.89 | - | 2.00 | 14.9 |\n"));
    EXPECT_THAT(made("trace-models"),
                HasSubstr("\n| sphere | 2,000,000 | 1 | 1,000,000 | 0.500 | 3 | 8 |\n"));
    EXPECT_THAT(made("trace-means"), HasSubstr("\n| primary | 2.00 | 2.00 | 1 |\n"));
}

TEST(DocumentTables, MistakesAreNamed) {
    const TempFolder folder;
    writeText(folder / "a.jsonl", "{}\n");
    writeText(folder / "broken.jsonl", "{\n");
    const std::string end = "<!-- end of table -->\n";
    EXPECT_THROW(withTables("\n<!-- table nothing of a.jsonl -->\n" + end, folder.path()),
                 std::runtime_error);
    EXPECT_THROW(withTables("\n<!-- table verify of a.jsonl -->\n", folder.path()), std::runtime_error);
    EXPECT_THROW(withTables("\n<!-- table verify of a.jsonl -->\n" + end, folder.path()), std::runtime_error);
    EXPECT_THROW(withTables("\n<!-- table verify of broken.jsonl -->\n" + end, folder.path()),
                 std::runtime_error);
    const std::string waiting = "\n<!-- table verify of absent.jsonl -->\n| as it is |\n" + end;
    EXPECT_EQ(withTables(waiting, folder.path()).text, waiting);
    const std::string shown = "so:\n\n    <!-- table verify of a.jsonl -->\n";
    EXPECT_EQ(withTables(shown, folder.path()).text, shown);
}

}  // namespace
}  // namespace pfvox::test
