// Links between the documents, and the index of decisions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

#include "docs/documents.hpp"
#include "support/temp_folder.hpp"

namespace pfvox::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(DocumentLinks, LeadToFiles) {
    static const std::regex kLink(R"(\]\(([^)#\s]+)(#[^)]*)?\))");
    for (const fs::path& document : documents()) {
        const std::string text = readText(kProjectDir / document);
        for (std::sregex_iterator link(text.begin(), text.end(), kLink), end; link != end; ++link) {
            const std::string target = (*link)[1];
            if (target.find("://") != std::string::npos) continue;
            EXPECT_TRUE(fs::exists(kProjectDir / document.parent_path() / target))
                << document << " links to " << target;
        }
    }
}

TEST(DocumentLinks, TheIndexListsEveryDecisionByItsTitle) {
    const fs::path folder = kProjectDir / "docs/decisions";
    const std::string index = readText(folder / "README.md");
    for (const auto& entry : fs::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        if (name == "README.md") continue;
        const std::string text = readText(entry.path());
        ASSERT_THAT(text, StartsWith("# " + name.substr(0, 3) + " ")) << name;
        EXPECT_THAT(index, HasSubstr("- [" + text.substr(2, text.find('\n') - 2) + "](" + name + ")"));
    }
}

}  // namespace
}  // namespace pfvox::test
