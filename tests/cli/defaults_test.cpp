// What --help calls the default is what happens without the option: each such option of each program is left
// out, then given with what --help shows, and settings and bytes must be the same. An option that shows a
// default must have a row here.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "docs/tool_help.hpp"
#include "support/scene_assets.hpp"

namespace pfvox::test {
namespace {

using nlohmann::json;
using Arguments = std::vector<std::string>;

/// An option that shows a default.
struct Row {
    std::string tool;
    std::string command;  ///< empty = options of all commands, and of tools without commands
    std::string option;
    Arguments given =
        {};  ///< what says the same; empty = the option with what --help shows, up to a comma or semicolon
    Arguments others = {};  ///< for both runs, besides those that every run has
};

void PrintTo(const Row& row, std::ostream* out) {
    *out << row.tool << ' ' << row.command << ' ' << row.option;
}

const Arguments kTiny{"--resolution", "16,8,4,6"};
const Arguments kPicture{"--screenshot", "a.png", "--size", "24x16"};
const Arguments kFigures{"--size", "24x16"};

const std::vector<Row>& rows() {
    static const std::vector<Row> all{
        {"vox2pf", "", "--jobs"},
        {"vox2pf", "", "--color"},
        {"vox2pf", "convert", "--merge"},
        {"vox2pf", "convert", "--include-hidden"},
        {"vox2pf", "convert", "--frame"},
        {"vox2pf", "convert", "--voxel-size", {"--voxel-size", "0.1"}},
        {"vox2pf", "convert", "--svx-threshold"},
        {"vox2pf", "convert", "--vdb-threshold"},
        {"vox2pf", "convert", "--vdb-up"},
        {"vox2pf", "convert", "--hollow"},
        {"vox2pf", "convert", "--lod"},
        {"vox2pf", "convert", "--zstd-level"},
        {"vox2pf", "convert", "--profile"},
        {"vox2pf", "export", "--format", {"--format", "vox"}},
        {"probe-bake", "", "--jobs"},
        {"probe-bake", "", "--color"},
        {"probe-bake", "bake", "--profile", {}, {"--samples", "128"}},
        // What is given is that of probes, and of faces on the devices of these tests.
        {"probe-bake", "bake", "--noise", {"--noise", "0.02"}, {"--profile", "thesis"}},
        {"probe-bake", "bake", "--noise", {"--noise", "0.03"}},
        {"probe-bake", "bake", "--max-samples", {"--max-samples", "4096"}, {"--profile", "thesis"}},
        {"probe-bake", "bake", "--max-samples", {"--max-samples", "512"}},
        {"probe-bake", "bake", "--bounces", {}, kTiny},
        {"probe-bake", "bake", "--seed", {}, kTiny},
        {"probe-bake", "bake", "--filter", {}, kTiny},
        {"probe-bake", "bake", "--filter", {"--no-filter"}, {"--profile", "thesis"}},
        {"probe-bake", "bake", "--relocate", {}, kTiny},
        {"probe-bake", "bake", "--device-memory", {"--device-memory", "16777216"}, kTiny},
        {"probe-bake", "bake", "--probes", {}, kTiny},
        {"probe-bake", "bake", "--device", {"--device", "0"}, kTiny},
        {"probe-bake",
         "verify",
         "--camera",
         {"--camera", "front", "--camera", "back"},
         {"--size", "8x8", "--samples", "2"}},
        {"probe-bake", "verify", "--size", {}, {"--samples", "2"}},
        {"probe-bake", "verify", "--samples", {}, {"--size", "8x8"}},
        {"probe-bake", "verify", "--reference-noise", {}, {"--size", "8x8", "--samples", "2"}},
        {"probe-bake",
         "verify",
         "--max-samples",
         {"--max-samples", "32"},
         {"--size", "8x8", "--samples", "2"}},
        {"probe-bake", "verify", "--device", {"--device", "0"}, {"--size", "8x8", "--samples", "2"}},
        {"pfview", "", "--size"},
        {"pfview", "", "--camera", {"--camera", "front"}, kPicture},
        {"pfview", "", "--view", {}, kPicture},
        {"pfview", "", "--samples", {}, kPicture},
        {"pfview", "", "--samples", {"--samples", "1"}, kFigures},
        {"pfview", "", "--frames", {}, kPicture},
        {"pfview", "", "--lod-pixels", {}, kPicture},
        {"pfview", "", "--probes", {"--probes", "scene.pf_probe"}, kPicture},
        {"pfview", "", "--ground", {"--no-ground"}, kPicture},
        {"pfview", "", "--exposure", {}, kPicture},
        {"pfview", "", "--tonemap", {}, kPicture},
        {"pfview", "", "--device", {"--device", "0"}, kPicture},
    };
    return all;
}

bool isBuilt(const std::string& tool) {
    return std::ranges::count(builtTools(), tool) != 0;
}

TEST(Defaults, EveryOneThatIsShownIsTested) {
    std::size_t shown = 0;
    for (const ToolCommand& it : everyCommand()) {
        for (const HelpRow& row : helpRows(it)) {
            if (row.shown.empty()) continue;
            ++shown;
            const auto isOf = [&](const Row& tested) {
                return tested.tool == it.tool && tested.option == row.option &&
                       (tested.command.empty() || tested.command == it.command);
            };
            EXPECT_TRUE(std::ranges::any_of(rows(), isOf)) << it.tool << ' ' << it.command << ": no row for\n"
                                                           << row.line;
        }
    }
    EXPECT_GT(shown, 20u);
}

/// In words, or of a pair --x, --no-x of which one must hold.
TEST(Defaults, NoneIsToldWithoutTheTable) {
    static const std::regex kInWords(R"(\bdefault\b(?! or ))");
    static const std::regex kPair(R"(--[\w-]+, --no-)");
    for (const ToolCommand& it : everyCommand()) {
        for (const HelpRow& row : helpRows(it)) {
            const std::string text = row.line.substr(0, row.line.find(" (default: "));
            EXPECT_FALSE(std::regex_search(text, kInWords))
                << it.tool << ' ' << it.command << ": showDefault() tells it\n"
                << row.line;
            EXPECT_FALSE(row.shown.empty() && std::regex_search(text, kPair))
                << it.tool << ' ' << it.command << ":\n"
                << row.line;
        }
    }
}

TEST(Defaults, NoRowIsOfAnOptionThatIsGone) {
    std::set<std::string> shown;
    for (const ToolCommand& it : everyCommand())
        for (const HelpRow& row : helpRows(it))
            if (!row.shown.empty()) shown.insert(it.tool + row.option);
    for (const Row& row : rows()) {
        if (!isBuilt(row.tool)) continue;
        EXPECT_THAT(shown, ::testing::Contains(row.tool + row.option));
    }
}

/// Left out and given, over and over.
class DefaultTest : public ::testing::TestWithParam<Row> {
  protected:
    void SetUp() override {
        if (!isBuilt(GetParam().tool)) GTEST_SKIP() << GetParam().tool << " was not built";
        std::filesystem::copy_file(std::filesystem::path(PFVOX_DATA_DIR) / "lamp.vox", folder_ / "lamp.vox");
        writePfVox(folder_ / "box.pf_vox", boxAsset({{0, 0, 0}, {12, 6, 12}}, 0.1));
        writeText(folder_ / "scene.toml", R"(
probeGridPos = [0.6, 0.5, 0.6]
probeGridStep = 1
probeGridCount = [1, 1, 1]
[[cameras]]
name = "front"
position = [0.6, 1.2, 3]
target = [0.6, 0.3, 0.6]
[[cameras]]
name = "back"
position = [0.6, 1.2, -3]
target = [0.6, 0.3, 0.6]
[[models]]
name = "box"
path = "box.pf_vox"
)");
    }

    /// What --help shows, as arguments.
    static Arguments given(const Row& row) {
        if (!row.given.empty()) return row.given;
        std::vector<std::string> commands{row.command};
        if (row.command.empty() && row.tool != "pfview") commands = {"info"};
        for (const HelpRow& shown : helpRows({row.tool, commands[0]})) {
            if (shown.option != row.option) continue;
            const std::string value = shown.shown.substr(0, shown.shown.find_first_of(",;"));
            return value.starts_with("--") ? Arguments{value} : Arguments{row.option, value};
        }
        ADD_FAILURE() << "no default is shown";
        return {};
    }

    std::string run(Arguments arguments) const {
        const std::string tool = arguments[0];
        arguments[0] = std::string(PFVOX_TOOLS_DIR) + "/" + tool;
        const ProcessResult result =
            runProcess(arguments, {.environment = {}, .input = {}, .folder = folder_.path()});
        EXPECT_EQ(result.exitCode, 0) << ::testing::PrintToString(arguments) << "\n" << result.err;
        return result.out;
    }

    /// What comes of a command line: settings and bytes.
    std::string outcome(const Arguments& arguments) const {
        const std::string command = GetParam().tool + " " + GetParam().command;
        if (command == "vox2pf convert") return convert(arguments);
        if (command == "vox2pf export") return exported(arguments);
        if (command == "probe-bake bake") return bake(arguments);
        if (command == "probe-bake verify") return verify(arguments);
        if (command == "pfview ") return view(arguments);
        return inspect(arguments);
    }

  private:
    static Arguments joined(Arguments first, const Arguments& second) {
        first.insert(first.end(), second.begin(), second.end());
        return first;
    }

    /// Times, rates and memory are not the same twice.
    static void eraseMeasured(json& value) {
        if (!value.is_structured()) return;
        for (auto at = value.begin(); at != value.end();) {
            const std::string key = value.is_object() ? at.key() : "";
            const bool measured = key.ends_with("Ms") || key.ends_with("PerSecond") || key == "deviceMemory";
            if (!measured) eraseMeasured(*at);
            at = measured ? value.erase(at) : std::next(at);
        }
    }

    /// The content key in the file is of every setting, also of those of other formats.
    std::string convert(const Arguments& arguments) const {
        run(joined({"vox2pf", "convert", "lamp.vox", "-o", "lamp.pf_vox", "--force"}, arguments));
        if (GetParam().option != "--voxel-size") return readText(folder_ / "lamp.pf_vox");
        // The size that a source has of its own is another setting than the same size given, and another key.
        json info = json::parse(run({"vox2pf", "info", "lamp.pf_vox", "--json"}));
        info.erase("contentKey");
        return info.dump(1);
    }

    std::string exported(const Arguments& arguments) const {
        run({"vox2pf", "convert", "lamp.vox", "-o", "lamp.pf_vox"});
        run(joined({"vox2pf", "export", "lamp.pf_vox", "-o", "back/"}, arguments));
        std::string all;
        for (const auto& [name, bytes] : readTree(folder_ / "back")) all += name + bytes;
        return all;
    }

    /// The key is of all that decides the content; bytes are made where that is quick.
    std::string bake(const Arguments& arguments) const {
        const Arguments bare(arguments.begin() + static_cast<std::ptrdiff_t>(GetParam().others.size()),
                             arguments.end());
        const Arguments line{"probe-bake", "bake", "scene.toml", "-o", "scene.pf_probe"};
        std::string all;
        for (const Arguments& options : {bare, arguments}) {
            if (options == bare && std::ranges::count(GetParam().others, std::string("--profile")) != 0)
                continue;
            const json planned = json::parse(run(joined(joined(line, {"--dry-run", "--json"}), options)));
            all += planned["contentKey"].get<std::string>() + "\n";
        }
        if (std::ranges::count(arguments, std::string("thesis")) != 0) return all;
        run(joined(joined(line, {"--force"}), arguments));
        return all + readText(folder_ / "scene.pf_probe");
    }

    void bakeOnce() const {
        run({"probe-bake", "bake", "scene.toml", "-o", "scene.pf_probe", "--resolution", "16,8,4,6",
             "--samples", "32"});
    }

    std::string verify(const Arguments& arguments) const {
        bakeOnce();
        std::istringstream lines(
            run(joined({"probe-bake", "verify", "scene.toml", "scene.pf_probe", "--json"}, arguments)));
        std::string all;
        for (std::string line; std::getline(lines, line);) {
            json score = json::parse(line);
            eraseMeasured(score);
            all += score.dump(1) + "\n";
        }
        return all;
    }

    std::string view(const Arguments& arguments) const {
        if (isBuilt("probe-bake")) bakeOnce();
        json all = json::parse(run(joined({"pfview", "scene.toml", "--stats-json", "-"}, arguments)));
        eraseMeasured(all);
        const bool hasPicture = std::filesystem::exists(folder_ / "a.png");
        if (!hasPicture) {  // how many frames were drawn before those that count depends on the time they
                            // took
            all.erase("light");
            for (const char* const counted :
                 {"hits", "steps", "stepsPerCameraRay", "sunRays", "ambientRays", "reflectionRays"})
                all["picture"].erase(counted);
        }
        return all.dump(1) + (hasPicture ? readText(folder_ / "a.png") : "");
    }

    std::string inspect(const Arguments& arguments) const {
        if (GetParam().tool == "vox2pf") return run(joined({"vox2pf", "info", "box.pf_vox"}, arguments));
        bakeOnce();
        return run(joined({"probe-bake", "info", "scene.pf_probe"}, arguments));
    }

    TempFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(Options, DefaultTest, ::testing::ValuesIn(rows()));

TEST_P(DefaultTest, LeftOutIsTheSameAsGiven) {
    Arguments arguments = GetParam().others;
    const std::string without = outcome(arguments);
    const Arguments added = given(GetParam());
    arguments.insert(arguments.end(), added.begin(), added.end());
    const std::string with = outcome(arguments);
    ASSERT_FALSE(without.empty());
    const auto apart = std::ranges::mismatch(without, with);
    const auto from = std::max<std::ptrdiff_t>(apart.in1 - without.begin() - 100, 0);
    EXPECT_TRUE(without == with) << ::testing::PrintToString(added) << " is not what holds without it:\n"
                                 << without.substr(static_cast<std::size_t>(from), 300) << "\nand\n"
                                 << with.substr(static_cast<std::size_t>(from), 300);
}

}  // namespace
}  // namespace pfvox::test
