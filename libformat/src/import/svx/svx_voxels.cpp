#include "import/svx/svx_voxels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "import/color_palette.hpp"
#include "import/label_materials.hpp"
#include "import/model_budget.hpp"

namespace pfvox::import::svx {

namespace {

constexpr std::size_t kMaxColors = 65535;

/// One slice, decoded and decided.
struct SliceContent {
    std::vector<std::uint8_t> solid;       ///< 1 or 0 for each pixel
    std::vector<glm::u8vec4> colors;       ///< empty without a color channel
    std::vector<MaterialIndex> materials;  ///< empty without material channels
};

class SliceDecoder {
  public:
    SliceDecoder(SliceReader& reader, const ChannelPlan& plan, double threshold)
        : reader_(reader), plan_(plan), threshold_(threshold) {}

    Result<SliceContent> decode(std::uint32_t slice) {
        SliceContent content;
        if (plan_.density != nullptr) {
            PFVOX_TRY(const ScalarImage, density, reader_.scalar(*plan_.density, slice));
            content.solid.resize(density.values.size());
            std::ranges::transform(density.values, content.solid.begin(), [&](std::uint16_t value) {
                return isSolid(static_cast<double>(value) / density.maximum);
            });
        }
        if (plan_.color != nullptr) {
            PFVOX_CHECK(decodeColors(slice, content));
        } else if (plan_.hasColors()) {
            PFVOX_CHECK(decodePrimaries(slice, content));
        }
        if (!plan_.materials.empty()) PFVOX_CHECK(decodeMaterials(slice, content));
        return content;
    }

  private:
    std::uint8_t isSolid(double fraction) const { return fraction > 0.0 && fraction >= threshold_ ? 1 : 0; }

    Result<void> decodeColors(std::uint32_t slice, SliceContent& content) {
        PFVOX_TRY(ColorImage, image, reader_.color(*plan_.color, slice));
        content.colors = std::move(image.pixels);
        if (!content.solid.empty()) return {};
        if (!image.hasAlpha)
            return plan_.materials.empty() ? failWithoutMatter(plan_.color->type) : Result<void>{};
        content.solid.resize(content.colors.size());
        std::ranges::transform(content.colors, content.solid.begin(),
                               [&](glm::u8vec4 color) { return isSolid(color.a / 255.0); });
        return {};
    }

    /// Three channels of one component each.
    Result<void> decodePrimaries(std::uint32_t slice, SliceContent& content) {
        if (content.solid.empty() && plan_.materials.empty())
            return failWithoutMatter(plan_.primaries[0]->type);
        for (std::size_t c = 0; c < plan_.primaries.size(); ++c) {
            PFVOX_TRY(const ScalarImage, image, reader_.scalar(*plan_.primaries[c], slice));
            content.colors.resize(image.values.size(), glm::u8vec4{0, 0, 0, 255});
            for (std::size_t i = 0; i < image.values.size(); ++i) {
                const std::uint32_t scaled = (image.values[i] * 255u + image.maximum / 2u) / image.maximum;
                content.colors[i][static_cast<int>(c)] = static_cast<std::uint8_t>(scaled);
            }
        }
        return {};
    }

    static Result<void> failWithoutMatter(const std::string& channel) {
        return fail(
            ErrorCode::UnsupportedFeature,
            fmt::format("channel {} gives colors, but no channel says where matter is: a DENSITY channel, a "
                        "MATERIAL channel or an alpha channel is needed",
                        channel));
    }

    /// The largest fraction wins; of equal ones the first channel. Voxels without any get the material after
    /// the last.
    Result<void> decodeMaterials(std::uint32_t slice, SliceContent& content) {
        const auto pixels = static_cast<std::size_t>(reader_.stack().imageSize().pixels());
        std::vector<float> largest(pixels, 0.0f);
        std::vector<float> sum(pixels, 0.0f);
        content.materials.assign(pixels, static_cast<MaterialIndex>(plan_.materials.size()));
        for (std::size_t m = 0; m < plan_.materials.size(); ++m) {
            PFVOX_TRY(const ScalarImage, image, reader_.scalar(*plan_.materials[m], slice));
            for (std::size_t i = 0; i < pixels; ++i) {
                const float fraction =
                    static_cast<float>(image.values[i]) / static_cast<float>(image.maximum);
                sum[i] += fraction;
                if (fraction <= largest[i]) continue;
                largest[i] = fraction;
                content.materials[i] = static_cast<MaterialIndex>(m);
            }
        }
        if (!content.solid.empty()) return {};
        content.solid.resize(pixels);
        std::ranges::transform(sum, content.solid.begin(),
                               [&](float s) { return isSolid(static_cast<double>(s)); });
        return {};
    }

    SliceReader& reader_;
    const ChannelPlan& plan_;
    double threshold_;
};

/// First of two passes: which colors the solid voxels have.
Result<void> collectColors(SliceDecoder& decoder, std::uint32_t sliceCount, ColorPalette& palette) {
    for (std::uint32_t slice = 0; slice < sliceCount; ++slice) {
        PFVOX_TRY(const SliceContent, content, decoder.decode(slice));
        for (std::size_t i = 0; i < content.solid.size(); ++i) {
            if (content.solid[i] != 0) palette.add(glm::u8vec3{content.colors[i]});
        }
    }
    palette.finish();
    return {};
}

void writeSlice(const SliceStack& stack, std::uint32_t slice, const SliceContent& content,
                const ColorPalette* palette, VoxelModel& model) {
    const ImageSize size = stack.imageSize();
    std::size_t i = 0;
    for (std::uint32_t row = 0; row < size.height; ++row) {
        for (std::uint32_t column = 0; column < size.width; ++column, ++i) {
            if (content.solid[i] == 0) continue;
            MaterialIndex material = 0;
            if (palette != nullptr) {
                material = palette->indexOf(glm::u8vec3{content.colors[i]});
            } else if (!content.materials.empty()) {
                material = content.materials[i];
            }
            model.set(stack.voxelAt(slice, column, row), material);
        }
    }
}

std::vector<Material> colorMaterials(const ColorPalette& palette) {
    std::vector<Material> materials;
    materials.reserve(palette.colors().size());
    for (const glm::u8vec3 color : palette.colors()) {
        Material material;
        material.baseColor = glm::u8vec4{color, 255};
        materials.push_back(std::move(material));
    }
    return materials;
}

/// One for each material channel, and one for voxels that have none.
std::vector<Material> channelMaterials(const ChannelPlan& plan, const Manifest& manifest) {
    std::vector<Material> materials;
    for (const Channel* channel : plan.materials) {
        const auto urn = manifest.materialUrns.find(channel->id);
        std::string name = urn != manifest.materialUrns.end() && !urn->second.empty()
                               ? urn->second
                               : fmt::format("material {}", channel->id);
        if (plan.materials.size() == 1) {
            materials.push_back(Material{.name = std::move(name)});
        } else {
            materials.push_back(labelMaterial(channel->id, std::move(name)));
        }
    }
    materials.emplace_back();
    return materials;
}

}  // namespace

Result<void> readVoxels(SliceReader& reader, const ChannelPlan& plan, const Manifest& manifest,
                        const ImportSettings& settings, const Limits& limits, VoxelAsset& asset,
                        Diagnostics& diagnostics) {
    const std::uint32_t sliceCount = reader.stack().sliceCount();
    SliceDecoder decoder(reader, plan, settings.svx.threshold);
    std::optional<ColorPalette> palette;
    if (plan.hasColors()) {
        palette.emplace(std::min<std::size_t>(kMaxColors, limits.maxMaterials));
        PFVOX_CHECK(collectColors(decoder, sliceCount, *palette));
        asset.materials = colorMaterials(*palette);
        if (palette->quantised()) {
            diagnostics.warn("svx-colors-quantised",
                             fmt::format("{} colors were joined to {}", palette->distinctColors(),
                                         asset.materials.size()));
        }
    } else {
        asset.materials = channelMaterials(plan, manifest);
    }

    VoxelModel& model = asset.models.emplace_back();
    const ModelBudget budget(limits);
    for (std::uint32_t slice = 0; slice < sliceCount; ++slice) {
        PFVOX_TRY(const SliceContent, content, decoder.decode(slice));
        writeSlice(reader.stack(), slice, content, palette ? &*palette : nullptr, model);
        PFVOX_CHECK(budget.check(model));
    }
    return {};
}

}  // namespace pfvox::import::svx
