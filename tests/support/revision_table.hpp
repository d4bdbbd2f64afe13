// RevisionTable: what a program made of fixed inputs, by the key under which users' files count as up to
// date. A line of the file is "<key> <case> <hash>"; PFVOX_UPDATE_GOLDEN=1 adds the lines of a new key, and
// never changes those of an old one.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <span>
#include <string>
#include <utility>

#include "io/hash.hpp"

namespace pfvox::test {

inline std::string hashText(std::span<const std::byte> bytes) {
    io::Xxh3_128 hash;
    hash.update(bytes);
    std::string text;
    for (const std::uint8_t byte : hash.digest()) text += fmt::format("{:02x}", byte);
    return text;
}

class RevisionTable {
  public:
    explicit RevisionTable(const std::string& name)
        : file_(std::filesystem::path(PFVOX_TESTS_DIR) / "golden/data" / name) {
        std::ifstream stream(file_);
        for (std::string key, what, hash; stream >> key >> what >> hash;) hashes_[{key, what}] = hash;
    }

    /// Whether any line is about this case, whatever its key.
    bool knows(const std::string& what) const {
        for (const auto& [entry, hash] : hashes_)
            if (entry.second == what) return true;
        return false;
    }

    /// `remedy`: what to raise when other bytes came of it under the same key.
    void expect(const std::string& key, const std::string& what, const std::string& hash,
                const std::string& remedy) {
        const auto known = hashes_.find({key, what});
        if (known != hashes_.end()) {
            EXPECT_EQ(known->second, hash) << what << " gives other bytes than before under the same key "
                                           << key << ", so that users' files "
                                           << "would stay what they are: " << remedy;
            return;
        }
        if (std::getenv("PFVOX_UPDATE_GOLDEN") != nullptr) {
            std::ofstream(file_, std::ios::app) << key << ' ' << what << ' ' << hash << '\n';
            return;
        }
        ADD_FAILURE() << "no line for the key " << key << " in " << file_
                      << ": run with PFVOX_UPDATE_GOLDEN=1, or add\n"
                      << key << ' ' << what << ' ' << hash;
    }

  private:
    std::filesystem::path file_;
    std::map<std::pair<std::string, std::string>, std::string> hashes_;
};

}  // namespace pfvox::test
