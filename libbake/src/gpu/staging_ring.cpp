#include "gpu/staging_ring.hpp"

#include <algorithm>

namespace pfvox::gpu::detail {

namespace {
constexpr std::uint64_t kSegmentBytes = 16u << 20;
}

std::span<std::byte> StagingRing::stage(vk::Buffer target, std::uint64_t offsetBytes,
                                        std::uint64_t sizeBytes) {
    ensureRoom(sizeBytes);
    Segment& segment = segments_[current_];
    const std::uint64_t at = segment.usedBytes;
    segment.copies.push_back({target, {.srcOffset = at, .dstOffset = offsetBytes, .size = sizeBytes}});
    segment.usedBytes += (sizeBytes + 15) / 16 * 16;
    return {segment.memory.mapped + at, sizeBytes};
}

void StagingRing::ensureRoom(std::uint64_t sizeBytes) {
    if (segments_[current_].usedBytes + sizeBytes > segments_[current_].memory.sizeBytes &&
        segments_[current_].usedBytes != 0) {
        startCopying();
        goOn();
    }
    Segment& segment = segments_[current_];
    if (segment.memory.sizeBytes >= sizeBytes) return;
    services_.freed(segment.memory);
    segment.memory = {};
    segment.memory = services_.allocate(std::max(sizeBytes, kSegmentBytes));
}

void StagingRing::record(const Segment& segment, const vk::raii::CommandBuffer& commands) {
    for (const Copy& copy : segment.copies)
        commands.copyBuffer(*segment.memory.buffer, copy.target, copy.region);
}

void StagingRing::startCopying() {
    Segment& segment = segments_[current_];
    if (segment.copies.empty()) return;
    if (!*segment.commands) segment.commands = services_.createCommands();
    segment.commands.reset();
    segment.commands.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    record(segment, segment.commands);
    segment.commands.end();
    segment.submission = services_.submit(segment.commands);
    segment.copies.clear();
}

void StagingRing::goOn() {
    current_ = (current_ + 1) % segments_.size();
    services_.wait(segments_[current_].submission);
    segments_[current_].usedBytes = 0;
}

void StagingRing::recordCopies(const vk::raii::CommandBuffer& commands) {
    record(segments_[current_], commands);
}

void StagingRing::submitted(std::uint64_t submission) {
    Segment& segment = segments_[current_];
    if (segment.copies.empty()) return;
    segment.copies.clear();
    segment.submission = submission;
    goOn();
}

void StagingRing::forget(vk::Buffer target) {
    for (Segment& segment : segments_) {
        std::erase_if(segment.copies, [&](const Copy& copy) { return copy.target == target; });
        services_.wait(segment.submission);
    }
}

}  // namespace pfvox::gpu::detail
