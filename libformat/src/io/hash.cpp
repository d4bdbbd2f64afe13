#include "io/hash.hpp"

#include <xxhash.h>

#include <cstring>
#include <new>

namespace pfvox::io {

struct Xxh3_128::State {
    XXH3_state_t* xxh = XXH3_createState();
    State() {
        if (xxh == nullptr) throw std::bad_alloc();
        XXH3_128bits_reset(xxh);
    }
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() { XXH3_freeState(xxh); }
};

std::uint64_t xxh3_64(std::span<const std::byte> bytes) {
    return XXH3_64bits(bytes.data(), bytes.size());
}

Xxh3_128::Xxh3_128() : state_(std::make_unique<State>()) {}
Xxh3_128::~Xxh3_128() = default;

void Xxh3_128::update(std::span<const std::byte> bytes) {
    XXH3_128bits_update(state_->xxh, bytes.data(), bytes.size());
}

void Xxh3_128::update(std::string_view text) {
    const std::uint64_t size = text.size();
    XXH3_128bits_update(state_->xxh, &size, sizeof size);
    XXH3_128bits_update(state_->xxh, text.data(), text.size());
}

std::array<std::uint8_t, 16> Xxh3_128::digest() const {
    XXH128_canonical_t canonical;
    XXH128_canonicalFromHash(&canonical, XXH3_128bits_digest(state_->xxh));
    std::array<std::uint8_t, 16> bytes{};
    std::memcpy(bytes.data(), canonical.digest, bytes.size());
    return bytes;
}

}  // namespace pfvox::io
