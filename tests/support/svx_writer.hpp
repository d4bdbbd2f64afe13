// SvxWriter: SVX files and PNG slices of every kind, made in memory for tests with libzip and libspng.
#pragma once

#include <fmt/format.h>
#include <spng.h>
#include <zip.h>

#include <cstdint>
#include <cstring>
#include <functional>
#include <glm/glm.hpp>
#include <list>
#include <string>
#include <utility>
#include <vector>

#include "support/import_helpers.hpp"

namespace pfvox::test {

/// A PNG of given samples. `samples` holds width * height * channels values in the range of bitDepth.
struct PngSpec {
    std::uint32_t width = 1;
    std::uint32_t height = 1;
    std::uint8_t bitDepth = 8;
    std::uint8_t colorType = SPNG_COLOR_TYPE_GRAYSCALE;
    bool interlaced = false;
    std::vector<std::uint16_t> samples = {};
    std::vector<glm::u8vec3> palette = {};
};

inline std::uint32_t channelsOf(std::uint8_t colorType) {
    if (colorType == SPNG_COLOR_TYPE_TRUECOLOR) return 3;
    if (colorType == SPNG_COLOR_TYPE_TRUECOLOR_ALPHA) return 4;
    return colorType == SPNG_COLOR_TYPE_GRAYSCALE_ALPHA ? 2 : 1;
}

inline Bytes encodePng(const PngSpec& spec) {
    const std::uint32_t rowSamples = spec.width * channelsOf(spec.colorType);
    const std::size_t rowBytes = (std::size_t{rowSamples} * spec.bitDepth + 7) / 8;
    std::vector<std::uint8_t> packed(rowBytes * spec.height, 0);
    for (std::uint32_t y = 0; y < spec.height; ++y) {
        for (std::uint32_t x = 0; x < rowSamples; ++x) {
            const std::uint16_t value = spec.samples.at(std::size_t{y} * rowSamples + x);
            std::uint8_t* row = packed.data() + y * rowBytes;
            if (spec.bitDepth == 16) {
                std::memcpy(row + 2 * std::size_t{x}, &value, 2);
            } else {
                const std::uint32_t bit = x * spec.bitDepth;
                row[bit / 8] =
                    static_cast<std::uint8_t>(row[bit / 8] | (value << (8 - spec.bitDepth - bit % 8)));
            }
        }
    }
    spng_ctx* context = spng_ctx_new(SPNG_CTX_ENCODER);
    spng_set_option(context, SPNG_ENCODE_TO_BUFFER, 1);
    spng_ihdr header{};
    header.width = spec.width;
    header.height = spec.height;
    header.bit_depth = spec.bitDepth;
    header.color_type = spec.colorType;
    header.interlace_method = spec.interlaced ? 1 : 0;
    spng_set_ihdr(context, &header);
    if (!spec.palette.empty()) {
        spng_plte palette{};
        palette.n_entries = static_cast<std::uint32_t>(spec.palette.size());
        for (std::size_t i = 0; i < spec.palette.size(); ++i) {
            palette.entries[i].red = spec.palette[i].r;
            palette.entries[i].green = spec.palette[i].g;
            palette.entries[i].blue = spec.palette[i].b;
        }
        spng_set_plte(context, &palette);
    }
    const int code =
        spng_encode_image(context, packed.data(), packed.size(), SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE);
    EXPECT_EQ(code, 0) << spng_strerror(code);
    std::size_t size = 0;
    int error = 0;
    void* png = spng_get_png_buffer(context, &size, &error);
    const auto* data = static_cast<const std::byte*>(png);
    Bytes bytes(data, data + size);
    std::free(png);
    spng_ctx_free(context);
    return bytes;
}

inline Bytes toBytes(std::string_view text) {
    const auto* data = reinterpret_cast<const std::byte*>(text.data());
    return {data, data + text.size()};
}

/// A zip archive in memory.
class ZipWriter {
  public:
    void add(std::string name, Bytes contents) {
        entries_.emplace_back(std::move(name), std::move(contents));
    }
    void add(std::string name, std::string_view text) { add(std::move(name), toBytes(text)); }

    Bytes finish() const {
        zip_error_t error;
        zip_error_init(&error);
        zip_source_t* target = zip_source_buffer_create(nullptr, 0, 0, &error);
        zip_t* archive = zip_open_from_source(target, ZIP_TRUNCATE, &error);
        zip_source_keep(target);
        for (const auto& [name, contents] : entries_) {
            zip_source_t* source = zip_source_buffer(archive, contents.data(), contents.size(), 0);
            EXPECT_GE(zip_file_add(archive, name.c_str(), source, ZIP_FL_ENC_UTF_8), 0) << name;
        }
        EXPECT_EQ(zip_close(archive), 0);
        zip_stat_t stat;
        zip_source_stat(target, &stat);
        zip_source_open(target);
        Bytes bytes(static_cast<std::size_t>(stat.size));
        zip_source_read(target, bytes.data(), stat.size);
        zip_source_close(target);
        zip_source_free(target);
        return bytes;
    }

  private:
    std::list<std::pair<std::string, Bytes>> entries_;
};

/// An SVX whose channels are functions of the voxel.
class SvxWriter {
  public:
    using Sample = std::function<std::uint16_t(glm::ivec3)>;

    explicit SvxWriter(glm::ivec3 gridSize, char axis = 'Y') : gridSize_(gridSize), axis_(axis) {}

    std::string gridAttributes = R"(voxelSize="0.001" subvoxelBits="8")";
    std::string afterChannels;
    bool interlaced = false;

    /// Gray slices below `folder`.
    void addScalarChannel(const std::string& attributes, const std::string& folder, int bitDepth,
                          const Sample& sample) {
        addChannel(attributes, folder, static_cast<std::uint8_t>(bitDepth), SPNG_COLOR_TYPE_GRAYSCALE,
                   [&](glm::ivec3 v, std::vector<std::uint16_t>& out) { out.push_back(sample(v)); });
    }
    /// Truecolor slices below `folder`.
    void addColorChannel(const std::string& attributes, const std::string& folder,
                         const std::function<glm::u8vec3(glm::ivec3)>& color) {
        addChannel(attributes, folder, 8, SPNG_COLOR_TYPE_TRUECOLOR,
                   [&](glm::ivec3 v, std::vector<std::uint16_t>& out) {
                       const glm::u8vec3 c = color(v);
                       out.insert(out.end(), {c.r, c.g, c.b});
                   });
    }
    /// Slices of any kind: `put` appends the samples of one voxel.
    void addChannel(const std::string& attributes, const std::string& folder, std::uint8_t bitDepth,
                    std::uint8_t colorType,
                    const std::function<void(glm::ivec3, std::vector<std::uint16_t>&)>& put,
                    std::vector<glm::u8vec3> palette = {}) {
        channels_ += fmt::format("<channel {} slices=\"{}/slice%04d.png\"/>", attributes, folder);
        const int axis = axis_ - 'X';
        for (int s = 0; s < gridSize_[axis]; ++s) {
            PngSpec spec{
                .bitDepth = bitDepth, .colorType = colorType, .interlaced = interlaced, .palette = palette};
            const int columnAxis = axis_ == 'X' ? 1 : 0;
            const int rowAxis = axis_ == 'Z' ? 1 : 2;
            spec.width = static_cast<std::uint32_t>(gridSize_[columnAxis]);
            spec.height = static_cast<std::uint32_t>(gridSize_[rowAxis]);
            for (int row = 0; row < gridSize_[rowAxis]; ++row) {
                for (int column = 0; column < gridSize_[columnAxis]; ++column) {
                    const glm::ivec3 voxel = axis_ == 'X'   ? glm::ivec3{s, column, row}
                                             : axis_ == 'Y' ? glm::ivec3{column, s, row}
                                                            : glm::ivec3{column, row, s};
                    put(voxel, spec.samples);
                }
            }
            zip.add(fmt::format("{}/slice{:04d}.png", folder, s), encodePng(spec));
        }
    }

    std::string manifest() const {
        return fmt::format(
            "<?xml version=\"1.0\"?>\n<grid version=\"1.0\" gridSizeX=\"{}\" gridSizeY=\"{}\" "
            "gridSizeZ=\"{}\" "
            "slicesOrientation=\"{}\" {}>\n<channels>{}</channels>{}</grid>\n",
            gridSize_.x, gridSize_.y, gridSize_.z, axis_, gridAttributes, channels_, afterChannels);
    }

    Bytes finish() {
        zip.add("manifest.xml", manifest());
        return zip.finish();
    }

    ZipWriter zip;

  private:
    glm::ivec3 gridSize_;
    char axis_;
    std::string channels_;
};

}  // namespace pfvox::test
