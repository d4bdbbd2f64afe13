// docs/architecture.md beside the build: the arrows are what CMake links, the rooms are folders and files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <sstream>

#include "docs/documents.hpp"
#include "support/temp_folder.hpp"

namespace pfvox::test {
namespace {

using ::testing::ContainerEq;
using ::testing::Gt;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using Arrows = std::set<std::string>;

std::string architecture() {
    return readText(kProjectDir / "docs/architecture.md");
}

/// "a --> b" of the diagram under this heading.
Arrows arrowsUnder(const std::string& heading) {
    const std::string text = architecture();
    std::istringstream in(text.substr(text.find(heading)));
    static const std::regex kArrow(R"(^  ([\w-]+) --> (\w+)$)");
    Arrows arrows;
    for (std::string line; std::getline(in, line) && !(line.starts_with("## ") && line != heading);) {
        std::smatch match;
        if (std::regex_match(line, match, kArrow)) arrows.insert(match[1].str() + " --> " + match[2].str());
    }
    return arrows;
}

/// Written by tests/docs/CMakeLists.txt: "a b" for each target of ours that a links.
Arrows arrowsOfTheBuild() {
    std::istringstream in(readText(PFVOX_TARGET_LINKS));
    Arrows arrows;
    for (std::string from, to; in >> from >> to;) arrows.insert(from + " --> " + to);
    return arrows;
}

TEST(Architecture, ArrowsAreWhatTheBuildLinks) {
    const Arrows built = arrowsOfTheBuild();
    if (!built.contains("pfview --> pfvox_viewer_window") || !built.contains("probe-bake --> pfvox_bake"))
        GTEST_SKIP() << "built without the GPU or without windows";
    const Arrows drawn = arrowsUnder("## Who may use whom");
    EXPECT_THAT(drawn, SizeIs(Gt(8u)));
    EXPECT_THAT(drawn, ContainerEq(built));
}

TEST(Architecture, RoomsAreThere) {
    const std::string text = architecture();
    const std::size_t begin = text.find("| room |");
    const std::string table = text.substr(begin, text.find("\n\n", begin) - begin);
    static const std::regex kRow(R"(\n\| (`[^|]*`) \|)");
    static const std::regex kPath("`([^`]+)`");
    int rooms = 0;
    for (std::sregex_iterator row(table.begin(), table.end(), kRow), end; row != end; ++row) {
        const std::string cell = (*row)[1];
        for (std::sregex_iterator path(cell.begin(), cell.end(), kPath); path != end; ++path, ++rooms)
            EXPECT_TRUE(std::filesystem::exists(kProjectDir / (*path)[1].str())) << (*path)[1];
    }
    EXPECT_GT(rooms, 15);
}

TEST(Architecture, NoFolderIsForgotten) {
    const std::string text = architecture();
    for (const char* const parent : {"libformat/src", "libbake/src", "tools", "viewer/src"}) {
        for (const auto& entry : std::filesystem::directory_iterator(kProjectDir / parent)) {
            const std::string room = parent + ("/" + entry.path().filename().string());
            if (!entry.is_directory()) continue;
            EXPECT_THAT(text, HasSubstr("`" + room + "`"));
        }
    }
}

}  // namespace
}  // namespace pfvox::test
