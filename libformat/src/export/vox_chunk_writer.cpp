#include "export/vox_chunk_writer.hpp"

namespace pfvox::vox_export {

Content& Content::byte(std::uint8_t value) {
    bytes_.push_back(std::byte{value});
    return *this;
}

Content& Content::i32(std::int64_t value) {
    for (unsigned shift = 0; shift < 32; shift += 8) byte(static_cast<std::uint8_t>(value >> shift));
    return *this;
}

Content& Content::text(std::string_view value) {
    i32(static_cast<std::int64_t>(value.size()));
    for (const char c : value) byte(static_cast<std::uint8_t>(c));
    return *this;
}

Content& Content::dict(const Dict& entries) {
    i32(static_cast<std::int64_t>(entries.size()));
    for (const auto& [key, value] : entries) text(key).text(value);
    return *this;
}

void ChunkWriter::add(std::string_view id, const Content& content) {
    for (const char c : id) chunks_.byte(static_cast<std::uint8_t>(c));
    chunks_.i32(static_cast<std::int64_t>(content.bytes().size())).i32(0);
    for (const std::byte b : content.bytes()) chunks_.byte(static_cast<std::uint8_t>(b));
}

std::vector<std::byte> ChunkWriter::finish() const {
    constexpr int kVersion = 150;
    Content file;
    for (const char c : std::string_view("VOX ")) file.byte(static_cast<std::uint8_t>(c));
    file.i32(kVersion);
    for (const char c : std::string_view("MAIN")) file.byte(static_cast<std::uint8_t>(c));
    file.i32(0).i32(static_cast<std::int64_t>(chunks_.bytes().size()));
    std::vector<std::byte> bytes(file.bytes().begin(), file.bytes().end());
    bytes.insert(bytes.end(), chunks_.bytes().begin(), chunks_.bytes().end());
    return bytes;
}

}  // namespace pfvox::vox_export
