// Names: the NAME section, read and written.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <pfvox/name.hpp>
#include <string_view>
#include <vector>

#include "container/section_reader.hpp"
#include "container/section_writer.hpp"

namespace pfvox {

/// All names of a file in one piece of memory, which the names that are taken out view and keep.
class NamePool {
  public:
    NamePool() = default;
    /// Errors: BadStructure, LimitExceeded, those of SectionReader.
    static Result<NamePool> read(const container::SectionReader& reader, const layout::Section& section);

    /// Indices that do not exist give the empty name: a name decides nothing. What is not UTF-8 is read as
    /// Windows-1252.
    Name at(std::uint32_t index) const;
    /// The first name that is not UTF-8.
    std::optional<std::uint32_t> firstForeign() const;

  private:
    std::string_view bytesOf(std::size_t index) const;
    std::uint32_t endOf(std::size_t index) const;
    Result<void> check(const layout::Section& section, std::size_t size);

    std::shared_ptr<const char[]> raw_;  ///< count_ + 1 ends of 32 bits, then the text
    std::size_t count_ = 0;
    std::map<std::uint32_t, Name> converted_;  ///< those that are not UTF-8
};

/// Every different name once; index 0 is the empty one. What is added must stay where it is.
class NameTable {
  public:
    NameTable() { add(""); }
    std::uint32_t add(std::string_view name);
    /// Errors: BadValue for a name that is not UTF-8, LimitExceeded for 4 GiB of names.
    Result<container::SectionContent> section() const;

  private:
    std::map<std::string_view, std::uint32_t> indexOf_;
    std::vector<std::string_view> names_;
};

}  // namespace pfvox
