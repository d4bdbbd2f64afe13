#include "container/frame.hpp"

#include <fmt/format.h>
#include <zstd.h>
#include <zstd_errors.h>

#include <memory>
#include <new>

namespace pfvox::container {

namespace {

struct FreeContext {
    void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
    void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

/// Of this thread, made when it is first needed.
template <class Context>
Context* contextOfThread(Context* (*create)()) {
    thread_local std::unique_ptr<Context, FreeContext> context;
    if (context == nullptr) context.reset(create());
    if (context == nullptr) throw std::bad_alloc();
    return context.get();
}

}  // namespace

Result<std::optional<std::vector<std::uint8_t>>> compressFrame(std::span<const std::byte> raw, int level,
                                                               Texture texture, std::size_t smallerThan) {
    ZSTD_CCtx* const context = contextOfThread(ZSTD_createCCtx);
    // Values out of range are impossible here, so the results need no check.
    ZSTD_CCtx_reset(context, ZSTD_reset_session_and_parameters);
    ZSTD_CCtx_setParameter(context, ZSTD_c_compressionLevel, level);
    if (texture == Texture::LocalSymbols) {
        ZSTD_CCtx_setParameter(context, ZSTD_c_windowLog, 13);
        ZSTD_CCtx_setParameter(context, ZSTD_c_minMatch, 7);
    }
    std::vector<std::uint8_t> frame(ZSTD_compressBound(raw.size()));
    const std::size_t size = ZSTD_compress2(context, frame.data(), frame.size(), raw.data(), raw.size());
    if (ZSTD_getErrorCode(size) == ZSTD_error_memory_allocation) throw std::bad_alloc();
    if (ZSTD_isError(size) != 0)
        return fail(ErrorCode::Internal, fmt::format("zstd cannot compress: {}", ZSTD_getErrorName(size)));
    if (size >= smallerThan) return std::optional<std::vector<std::uint8_t>>{};
    frame.resize(size);
    frame.shrink_to_fit();
    return std::optional(std::move(frame));
}

Result<void> checkFrame(std::span<const std::byte> head, std::uint64_t storedBytes, std::uint64_t rawBytes) {
    if (ZSTD_getFrameContentSize(head.data(), head.size()) == rawBytes &&
        leastFrameBytes(rawBytes) <= storedBytes)
        return {};
    return fail(ErrorCode::BadStructure, "the zstd frame does not have the announced size");
}

Result<void> decompressFrame(std::span<const std::byte> stored, std::span<std::byte> raw) {
    const std::size_t size = ZSTD_decompressDCtx(contextOfThread(ZSTD_createDCtx), raw.data(), raw.size(),
                                                 stored.data(), stored.size());
    if (ZSTD_isError(size) == 0 && size == raw.size()) return {};
    return fail(ErrorCode::ChecksumMismatch,
                fmt::format("cannot be decompressed: {}",
                            ZSTD_isError(size) != 0 ? ZSTD_getErrorName(size) : "short frame"));
}

}  // namespace pfvox::container
