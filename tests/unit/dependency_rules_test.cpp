// The house rules of docs/architecture.md that a compiler does not check.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

namespace pfvox {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = fs::path(PFVOX_TESTS_DIR).parent_path();

struct Rule {
    const char* name;
    const char* folder;
    const char* forbidden;                ///< regular expression, matched line by line
    std::vector<std::string> exceptions;  ///< files, relative to the root
};

std::vector<std::string> violations(const Rule& rule) {
    std::vector<std::string> found;
    const std::regex forbidden(rule.forbidden);
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / rule.folder)) {
        const std::string extension = entry.path().extension().string();
        if (extension != ".cpp" && extension != ".hpp" && extension != ".h" && extension != ".glsl" &&
            extension != ".comp")
            continue;
        const std::string name = entry.path().lexically_relative(kRoot).generic_string();
        if (std::ranges::find(rule.exceptions, name) != rule.exceptions.end()) continue;
        std::ifstream in(entry.path());
        int number = 0;
        for (std::string line; std::getline(in, line);) {
            ++number;
            if (std::regex_search(line, forbidden))
                found.push_back(name + ":" + std::to_string(number) + ": " + line);
        }
    }
    return found;
}

TEST(DependencyRules, Hold) {
    const char* const kTalk =
        R"(std::(cout|cerr)|[^\w](printf|fprintf|puts)\(|fmt::print|[^\w_]exit\(|getenv)";
    const char* const kOpen = R"([^\w](fopen|open)\(.*(O_RDONLY|O_WRONLY|"[rw]b?")|std::(i|o)?fstream)";
    std::vector<Rule> rules{
        {"libformat neither prints, exits nor reads the environment",
         "libformat",
         kTalk,
         {"libformat/src/error.cpp"}},
        {"libbake neither prints, exits nor reads the environment", "libbake", kTalk, {}},
        {"only io opens files",
         "libformat",
         kOpen,
         {"libformat/src/io/atomic_file.cpp", "libformat/src/io/pipe.cpp", "libformat/src/io/random_file.cpp",
          "libformat/src/io/temporary.cpp"}},
        {"libformat knows no Vulkan and no window", "libformat", R"(#include <(vulkan|GLFW|imgui))", {}},
        {"the format does not know the importers",
         "libformat/src/pf_vox",
         R"(#include ["<](import/|pfvox/import))",
         {}},
        {"the octree does not know the file",
         "libformat/src/octree",
         R"(#include ["<](pf_vox/|pfvox/pf_vox))",
         {}},
        {"public headers are free of third-party readers",
         "libformat/include",
         R"(#include <(openvdb|pugixml|zip|spng|zstd|xxhash|tbb|toml))",
         {}},
        {"OpenVDB stays in the files that read and write .vdb",
         "libformat",
         R"(#include <openvdb)",
         {"libformat/src/export/vdb_archive.cpp", "libformat/src/export/vdb_archive.hpp",
          "libformat/src/export/vdb_grids.hpp", "libformat/src/import/vdb/grid_colors.hpp",
          "libformat/src/import/vdb/grid_placement.hpp", "libformat/src/import/vdb/grid_voxels.cpp",
          "libformat/src/import/vdb/grid_voxels.hpp", "libformat/src/import/vdb/index_frame.hpp",
          "libformat/src/import/vdb/vdb_import.cpp", "libformat/src/import/vdb/vdb_reader.cpp",
          "libformat/src/import/vdb/vdb_reader.hpp"}},
        {"public headers of libbake are free of Vulkan", "libbake/include", R"(#include <vulkan)", {}},
        {"pairs of flags are declared by addSwitch()",
         "tools",
         R"(!--no-)",
         {"tools/common/command_line.cpp"}},
        {"pairs of flags are declared by addSwitch()", "viewer", R"(!--no-)", {}},
        {"the viewer consumes only what was built",
         "viewer",
         R"(#include <pfvox/(import|convert|export)\.hpp>)",
         {}},
    };
    const char* const kSrgb = R"(1\.055|12\.92|pow\(.*[^\d.]2\.2\b)";
    for (const char* folder :
         {"libformat", "libbake", "shaders", "tools", "viewer", "tests", "bench", "data"})
        rules.push_back({"there is one sRGB curve", folder, kSrgb, {"shaders/shared/color.glsl.h"}});
    for (const Rule& rule : rules) {
        SCOPED_TRACE(rule.name);
        for (const std::string& line : violations(rule)) ADD_FAILURE() << line;
    }
}

TEST(DependencyRules, NoFileIsTooLongToBeOneRoom) {
    constexpr int kMaxLines = 600;
    for (const char* folder :
         {"libformat", "libbake", "tools", "viewer", "shaders", "tests", "bench", "data"}) {
        for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) {
            const std::string extension = entry.path().extension().string();
            if (extension != ".cpp" && extension != ".hpp" && extension != ".glsl" && extension != ".comp")
                continue;
            std::ifstream in(entry.path());
            int lines = 0;
            for (std::string line; std::getline(in, line);) ++lines;
            EXPECT_LE(lines, kMaxLines) << entry.path();
        }
    }
}

}  // namespace
}  // namespace pfvox
