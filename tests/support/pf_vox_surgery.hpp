// Surgery on PF_VOX bytes: change anything and repair the hashes, so that a test reaches the check behind
// them.
#pragma once

#include <zstd.h>

#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "io/hash.hpp"
#include "pf_vox/layout.hpp"

namespace pfvox::test {

using Bytes = std::vector<std::byte>;

struct OpenFile {
    layout::Header header{};
    struct Part {
        layout::Section entry{};
        std::vector<std::uint8_t> raw;
    };
    std::vector<Part> parts;

    /// First section with this name (of this region).
    Part& part(const std::string& fourcc, std::uint32_t region = layout::kNoRegion) {
        for (Part& p : parts) {
            if (std::string(p.entry.fourcc.data(), 4) == fourcc && p.entry.region == region) return p;
        }
        throw std::logic_error("no section " + fourcc);
    }
    /// Record i of a table, for changing.
    template <class Record>
    void edit(const std::string& fourcc, std::size_t i, const std::function<void(Record&)>& change) {
        Part& p = part(fourcc);
        Record record;
        std::memcpy(&record, p.raw.data() + i * sizeof record, sizeof record);
        change(record);
        std::memcpy(p.raw.data() + i * sizeof record, &record, sizeof record);
    }
};

inline OpenFile openFile(const Bytes& file) {
    OpenFile open;
    std::memcpy(&open.header, file.data(), sizeof open.header);
    open.parts.resize(open.header.sectionCount);
    for (std::size_t i = 0; i < open.parts.size(); ++i) {
        OpenFile::Part& part = open.parts[i];
        std::memcpy(&part.entry, file.data() + sizeof open.header + i * sizeof part.entry, sizeof part.entry);
        const auto* stored = reinterpret_cast<const std::uint8_t*>(file.data()) + part.entry.offset;
        if (part.entry.codec == layout::Codec::Raw) {
            part.raw.assign(stored, stored + part.entry.storedBytes);
        } else {
            part.raw.resize(part.entry.rawBytes);
            ZSTD_decompress(part.raw.data(), part.raw.size(), stored, part.entry.storedBytes);
        }
    }
    return open;
}

/// Closes the file again, sizes and hashes right; counts and everything else as they were left. Sections are
/// raw, or zstd frames: bombs.
inline Bytes closeFile(OpenFile open, bool compressed = false) {
    open.header.sectionCount = static_cast<std::uint32_t>(open.parts.size());
    const std::size_t headBytes = sizeof open.header + open.parts.size() * sizeof(layout::Section);
    Bytes file(headBytes);
    for (std::size_t i = 0; i < open.parts.size(); ++i) {
        OpenFile::Part& part = open.parts[i];
        file.resize((file.size() + 63) / 64 * 64);
        part.entry.codec = layout::Codec::Raw;
        part.entry.offset = file.size();
        part.entry.rawBytes = part.raw.size();
        // The maps in DATA of a probe file have hashes of their own.
        const bool hasHash = std::string_view(part.entry.fourcc.data(), 4) != "DATA" &&
                             std::string_view(part.entry.fourcc.data(), 4) != "FDAT";
        part.entry.rawHash = hasHash ? io::xxh3_64(std::as_bytes(std::span(part.raw))) : 0;
        if (compressed && hasHash) {
            std::vector<std::uint8_t> frame(ZSTD_compressBound(part.raw.size()));
            frame.resize(ZSTD_compress(frame.data(), frame.size(), part.raw.data(), part.raw.size(), 1));
            part.entry.codec = layout::Codec::Zstd;
            part.raw = std::move(frame);
        }
        part.entry.storedBytes = part.raw.size();
        const auto stored = std::as_bytes(std::span(part.raw));
        file.insert(file.end(), stored.begin(), stored.end());
        std::memcpy(file.data() + sizeof open.header + i * sizeof part.entry, &part.entry, sizeof part.entry);
    }
    open.header.fileBytes = file.size();
    open.header.headHash = 0;
    std::memcpy(file.data(), &open.header, sizeof open.header);
    open.header.headHash = io::xxh3_64(std::span(file).first(headBytes));
    std::memcpy(file.data(), &open.header, sizeof open.header);
    return file;
}

/// Makes the hash over header and table right again after a change in them.
inline void repairHead(Bytes& file) {
    layout::Header header;
    std::memcpy(&header, file.data(), sizeof header);
    header.headHash = 0;
    std::memcpy(file.data(), &header, sizeof header);
    const std::size_t headBytes = sizeof header + header.sectionCount * sizeof(layout::Section);
    header.headHash = io::xxh3_64(std::span(file).first(std::min(headBytes, file.size())));
    std::memcpy(file.data(), &header, sizeof header);
}

}  // namespace pfvox::test
