// The maths of probe maps as a shader computes it, against the same text compiled as C++.
#include <bit>
#include <cstring>
#include <pfvox_check_shaders/shaders.hpp>
#include <random>

#include "shared/probe_maths_check.glsl.h"
#include "support/gpu_fixture.hpp"

namespace pfvox::test {
namespace {

using shared::ProbeMathsInput;
using shared::ProbeMathsOutput;

class ProbeMathsGpu : public GpuTest {
  protected:
    static std::vector<ProbeMathsInput> makeInputs(std::size_t count) {
        std::mt19937 random(7);
        std::normal_distribution<float> normal;
        std::uniform_real_distribution<float> uniform;
        std::vector<ProbeMathsInput> inputs(count);
        const float scale = 50;
        const float farMetres = 20;
        for (std::size_t i = 0; i < count; ++i) {
            ProbeMathsInput& in = inputs[i];
            in.direction = glm::normalize(glm::vec3{normal(random), normal(random), normal(random)});
            if (i < 26) in.direction = glm::normalize(axisOrDiagonal(i));
            in.metres = 1e-4f + uniform(random) * 1.1f * farMetres;
            const float magnitude = std::exp2(uniform(random) * 48 - 28);
            in.light = glm::vec3{uniform(random), uniform(random), normal(random)} * magnitude;
            in.resolution = 1u << (random() % 11);
            if (random() % 4 == 0) in.resolution = 14;
            in.depthScaleAndLogRange = {scale, std::log(scale * farMetres + 1)};
            in.code = static_cast<std::uint32_t>(random() % 65535);
            in.word = static_cast<std::uint32_t>(random());
        }
        return inputs;
    }

    /// The 26 neighbors of the origin: where folds and corners of the map are.
    static glm::vec3 axisOrDiagonal(std::size_t i) {
        const auto cell = static_cast<int>(i < 13 ? i : i + 1);
        return glm::vec3{cell % 3 - 1, cell / 3 % 3 - 1, cell / 9 - 1};
    }

    static void run(const std::vector<ProbeMathsInput>& inputs, std::vector<ProbeMathsOutput>& outputs) {
        outputs.resize(inputs.size());
        PFVOX_ASSERT_VALUE(const gpu::Buffer, in,
                           device().createBuffer(sizeof inputs[0] * inputs.size(), "inputs"));
        PFVOX_ASSERT_VALUE(const gpu::Buffer, out,
                           device().createBuffer(sizeof outputs[0] * outputs.size(), "outputs"));
        PFVOX_ASSERT_VALUE(const gpu::Program, program,
                           device().createProgram(shaders::kProbeMathsCheck,
                                                  sizeof(shared::ProbeMathsParameters), "probe maths check"));
        ASSERT_TRUE(device().upload(in, 0, std::as_bytes(std::span(inputs))));
        shared::ProbeMathsParameters push{};
        push.inputs = in.addressWords();
        push.outputs = out.addressWords();
        push.count = static_cast<std::uint32_t>(inputs.size());
        const gpu::Dispatch dispatch{
            .program = &program,
            .pushConstants = gpu::bytesOf(push),
            .groups = {(push.count + shared::kProbeMathsGroupSize - 1) / shared::kProbeMathsGroupSize, 1, 1}};
        ASSERT_TRUE(device().run({&dispatch, 1}));
        ASSERT_TRUE(device().download(out, 0, std::as_writable_bytes(std::span(outputs))));
    }
};

/// Texels that differ only because the direction lies on their common edge.
bool onAnEdge(const ProbeMathsInput& in) {
    const glm::vec2 t = shared::texelCoordinate(in.direction, in.resolution);
    const glm::vec2 off = glm::abs(t - glm::round(t));
    return std::min(off.x, off.y) < 1e-5f * static_cast<float>(in.resolution);
}

std::uint32_t difference(std::uint32_t a, std::uint32_t b) {
    return a > b ? a - b : b - a;
}

TEST_F(ProbeMathsGpu, ShadersComputeWhatCppComputes) {
    const std::vector<ProbeMathsInput> inputs = makeInputs(200000);
    std::vector<ProbeMathsOutput> outputs;
    run(inputs, outputs);
    std::size_t codesApart = 0;
    std::size_t normalsApart = 0;
    std::size_t seeing = 0;
    std::size_t seesApart = 0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        SCOPED_TRACE(i);
        const ProbeMathsInput& in = inputs[i];
        const ProbeMathsOutput cpp = shared::checkProbeMaths(in);
        const ProbeMathsOutput& gpu = outputs[i];
        ASSERT_LT(glm::distance(gpu.decoded, in.direction), 1e-5f);
        // Integer packs have the same bits everywhere.
        ASSERT_EQ(gpu.lightBits, cpp.lightBits);
        ASSERT_EQ(gpu.momentsBits, cpp.momentsBits);
        ASSERT_EQ(gpu.finite, cpp.finite);
        ASSERT_EQ(gpu.borderTexel, cpp.borderTexel);
        if (cpp.finite != 0) {
            ASSERT_EQ(gpu.lightOfWord, cpp.lightOfWord);
        }
        if ((in.word & 0x7c00u) != 0x7c00u && (in.word >> 16 & 0x7c00u) != 0x7c00u) {
            ASSERT_EQ(gpu.momentsOfWord, cpp.momentsOfWord);
        }
        if (!onAnEdge(in)) {
            ASSERT_EQ(gpu.texel, cpp.texel);
            ASSERT_LT(glm::distance(gpu.texelDirection, cpp.texelDirection), 1e-5f);
            ASSERT_NEAR(gpu.solidAngle / cpp.solidAngle, 1, 1e-5f);
        }
        // What goes through floating point may differ by one step.
        ASSERT_LE(difference(gpu.depthBits, cpp.depthBits), 1u);
        ASSERT_NEAR(gpu.depth / std::max(cpp.depth, 1e-3f), cpp.depth / std::max(cpp.depth, 1e-3f), 1e-4f);
        ASSERT_LT(glm::distance(gpu.normal, cpp.normal), 0.03f);
        codesApart += gpu.depthBits != cpp.depthBits ? 1u : 0u;
        normalsApart += gpu.normalBits != cpp.normalBits ? 1u : 0u;
        seeing += gpu.sees;
        seesApart += gpu.sees != cpp.sees ? 1u : 0u;
    }
    EXPECT_LE(codesApart, inputs.size() / 100);
    EXPECT_LE(normalsApart, inputs.size() / 1000);
    EXPECT_LE(seesApart, inputs.size() / 1000);
    EXPECT_GT(seeing, inputs.size() / 20);  // both answers occur
    EXPECT_LT(seeing, inputs.size() * 19 / 20);
    RecordProperty("depth_codes_apart", static_cast<int>(codesApart));
    RecordProperty("normals_apart", static_cast<int>(normalsApart));
}

}  // namespace
}  // namespace pfvox::test
