// SectionReader: the raw bytes of sections. Sizes are checked against the tables before anything is
// allocated, and hashes before anything is believed.
#pragma once

#include <cstdint>
#include <span>

#include "container/file_head.hpp"

namespace pfvox::container {

/// May be used from several threads at once.
class SectionReader {
  public:
    SectionReader(const ByteSource& source, MemoryBudget& budget) : source_(source), budget_(budget) {}

    MemoryBudget& budget() const { return budget_; }

    /// Whether sizes and codec are those of so many bytes. Errors: BadStructure, UnsupportedFeature (codec);
    /// those of the source.
    Result<void> checkSize(const layout::Section& section, std::uint64_t rawBytes) const;

    /// The content, into memory that is there already. Precondition: checkSize(section, raw.size()) found
    /// nothing. Errors: ChecksumMismatch, LimitExceeded; those of the source.
    Result<void> fill(const layout::Section& section, std::span<std::byte> raw) const;

    /// The content as bytes, little-endian words or records: as many as the tables say. Errors: those of
    /// both.
    template <class T>
    Result<Array<T>> read(const layout::Section& section, std::uint64_t count) const {
        if (count > ~std::uint64_t{0} / sizeof(T))
            return failInSection(section, ErrorCode::BadStructure, "more entries than any file can hold");
        PFVOX_CHECK(checkSize(section, count * sizeof(T)));
        auto content = Array<T>::make(budget_, count);
        if (!content) return failInSection(section, content.error().code, std::move(content.error().message));
        PFVOX_CHECK(fill(section, std::as_writable_bytes(std::span(*content))));
        return content;
    }

  private:
    const ByteSource& source_;
    MemoryBudget& budget_;
};

}  // namespace pfvox::container
