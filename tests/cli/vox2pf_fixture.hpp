// What the tests of vox2pf share: a folder of their own, the program, and sources to feed it.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "support/process.hpp"
#include "support/temp_folder.hpp"

namespace pfvox::test {

class Vox2pf : public ::testing::Test {
  protected:
    /// Runs vox2pf in the test's folder.
    ProcessResult run(std::vector<std::string> arguments, ProcessSetup setup = {}) const {
        arguments.insert(arguments.begin(), PFVOX_VOX2PF);
        if (setup.folder.empty()) setup.folder = folder.path();
        return runProcess(std::move(arguments), setup);
    }

    /// Puts a demo source into the test's folder under another name.
    std::filesystem::path addSource(const std::filesystem::path& name,
                                    const std::string& demo = "lamp.vox") const {
        const std::filesystem::path target = folder / name;
        std::filesystem::create_directories(target.parent_path());
        std::filesystem::copy_file(std::filesystem::path(PFVOX_DATA_DIR) / demo, target);
        return target;
    }

    /// Changes the color of every voxel value: byte `fromEnd` before the end of the palette.
    static void changeOneByte(const std::filesystem::path& file) {
        std::string bytes = readText(file);
        const std::size_t palette = bytes.find("RGBA");
        ASSERT_NE(palette, std::string::npos);
        for (std::size_t i = palette + 12; i < palette + 12 + 1024; i += 4)
            bytes[i] = static_cast<char>(bytes[i] ^ 1);
        writeText(file, bytes);
    }

    /// A file that is a VOX by its name and start, but ends too early.
    void addBrokenSource(const std::filesystem::path& name) const {
        const std::string good = readText(std::filesystem::path(PFVOX_DATA_DIR) / "lamp.vox");
        writeText(folder / name, good.substr(0, 500));
    }

    bool exists(const std::filesystem::path& name) const { return std::filesystem::exists(folder / name); }

    std::vector<std::string> filesBelow(const std::filesystem::path& name) const {
        std::vector<std::string> names;
        for (const auto& [file, content] : readTree(folder / name)) names.push_back(file);
        return names;
    }

    TempFolder folder;
};

/// The lines of a text, without empty ones.
inline std::vector<std::string> linesOf(const std::string& text) {
    std::vector<std::string> lines;
    std::string line;
    for (const char c : text) {
        if (c != '\n') {
            line += c;
        } else if (!line.empty()) {
            lines.push_back(std::move(line));
            line.clear();
        }
    }
    if (!line.empty()) lines.push_back(line);
    return lines;
}

}  // namespace pfvox::test
