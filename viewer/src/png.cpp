#include "png.hpp"

#include <spng.h>

#include <memory>
#include <string>

#include "io/files.hpp"

namespace pfvox::viewer {

namespace {

constexpr std::uint32_t kMaxEdge = 16384;
constexpr std::uint64_t kMaxPngBytes = 1u << 30;

struct ContextDeleter {
    void operator()(spng_ctx* context) const { spng_ctx_free(context); }
};
using Context = std::unique_ptr<spng_ctx, ContextDeleter>;

struct FreeDeleter {
    void operator()(void* bytes) const { std::free(bytes); }
};

tl::unexpected<Error> spngError(ErrorCode code, int status) {
    return fail(code, std::string("PNG: ") + spng_strerror(status));
}

}  // namespace

Result<std::vector<std::byte>> encodePng(const Picture& picture) {
    const Context context(spng_ctx_new(SPNG_CTX_ENCODER));
    if (!context) return fail(ErrorCode::Internal, "PNG: cannot start the encoder");
    spng_ihdr header{};
    header.width = picture.width;
    header.height = picture.height;
    header.bit_depth = 8;
    header.color_type = SPNG_COLOR_TYPE_TRUECOLOR_ALPHA;
    spng_set_option(context.get(), SPNG_ENCODE_TO_BUFFER, 1);
    int status = spng_set_ihdr(context.get(), &header);
    if (status == 0) {
        status = spng_encode_image(context.get(), picture.pixels.data(), 4 * picture.pixels.size(),
                                   SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE);
    }
    if (status != 0) return spngError(ErrorCode::Internal, status);
    std::size_t sizeBytes = 0;
    const std::unique_ptr<void, FreeDeleter> bytes(spng_get_png_buffer(context.get(), &sizeBytes, &status));
    if (!bytes) return spngError(ErrorCode::Internal, status);
    const auto* first = static_cast<const std::byte*>(bytes.get());
    return std::vector<std::byte>(first, first + sizeBytes);
}

Result<Picture> decodePng(std::span<const std::byte> bytes) {
    const Context context(spng_ctx_new(0));
    if (!context) return fail(ErrorCode::Internal, "PNG: cannot start the decoder");
    spng_ihdr header{};
    std::size_t sizeBytes = 0;
    int status = spng_set_png_buffer(context.get(), bytes.data(), bytes.size());
    if (status == 0) status = spng_get_ihdr(context.get(), &header);
    if (status != 0) return spngError(ErrorCode::BadValue, status);
    if (header.width > kMaxEdge || header.height > kMaxEdge) {
        return fail(ErrorCode::LimitExceeded, "PNG: more than 16384 pixels wide or high");
    }
    Picture picture{.width = header.width,
                    .height = header.height,
                    .pixels = std::vector<std::uint32_t>(std::size_t{header.width} * header.height)};
    status = spng_decoded_image_size(context.get(), SPNG_FMT_RGBA8, &sizeBytes);
    if (status == 0 && sizeBytes != 4 * picture.pixels.size()) status = SPNG_EINTERNAL;
    if (status == 0) {
        status = spng_decode_image(context.get(), picture.pixels.data(), sizeBytes, SPNG_FMT_RGBA8, 0);
    }
    if (status != 0) return spngError(ErrorCode::BadValue, status);
    return picture;
}

Result<void> writePng(const std::filesystem::path& file, const Picture& picture) {
    PFVOX_TRY(const std::vector<std::byte>, bytes, encodePng(picture));
    return io::writeFileAtomically(file, bytes);
}

Result<Picture> readPng(const std::filesystem::path& file) {
    PFVOX_TRY(const io::FileBytes, contents, io::readFile(file, kMaxPngBytes));
    Result<Picture> picture = decodePng(contents.bytes());
    if (!picture) picture.error().file = file;
    return picture;
}

}  // namespace pfvox::viewer
