// The structs of shaders/shared have the same bytes for C++ and for the shaders.
#include <bit>
#include <cstring>
#include <pfvox_check_shaders/shaders.hpp>

#include "shared/rays.glsl.h"
#include "shared/scene.glsl.h"
#include "shared/view.glsl.h"
#include "support/gpu_fixture.hpp"

namespace pfvox::test {
namespace {

using LayoutTest = GpuTest;

constexpr std::uint32_t kFirst =
    0x3f800000u;  // as floats these are ordinary numbers, which no driver flushes to zero

/// Word number of a member in element 1 of an array of T.
template <class T>
std::uint32_t wordOf(std::size_t memberOffset) {
    return kFirst + static_cast<std::uint32_t>((sizeof(T) + memberOffset) / 4);
}
#define PFVOX_WORD(type, member) wordOf<shared::type>(offsetof(shared::type, member))

std::vector<std::uint32_t> expectedWords() {
    return {PFVOX_WORD(WideNode, maskLow),
            PFVOX_WORD(WideNode, kind),
            PFVOX_WORD(BvhNode, first),
            PFVOX_WORD(BvhNode, boxMax) + 2,
            PFVOX_WORD(BvhNode, count),
            PFVOX_WORD(InstanceRecord, cubeFromWorld2) + 3,
            PFVOX_WORD(InstanceRecord, model),
            PFVOX_WORD(InstanceRecord, id),
            PFVOX_WORD(ModelRecord, leafScale),
            PFVOX_WORD(ModelRecord, lods),
            PFVOX_WORD(ModelRecord, nodes) + 1,
            PFVOX_WORD(ModelRecord, originVoxels) + 2,
            PFVOX_WORD(MaterialRecord, emissionStrength),
            PFVOX_WORD(MaterialRecord, type),
            PFVOX_WORD(MaterialRecord, alpha),
            PFVOX_WORD(SceneHeader, materials) + 1,
            PFVOX_WORD(SceneHeader, materialCount),
            PFVOX_WORD(RayRecord, tMax),
            PFVOX_WORD(RayRecord, direction) + 2,
            PFVOX_WORD(HitRecord, t),
            PFVOX_WORD(HitRecord, normal) + 2,
            PFVOX_WORD(HitRecord, material),
            PFVOX_WORD(HitRecord, stepLimitReached),
            PFVOX_WORD(ViewParameters, samplesPerPixel),
            PFVOX_WORD(ViewParameters, mode),
            PFVOX_WORD(ViewParameters, exposure),
            PFVOX_WORD(ViewParameters, stepScale),
            PFVOX_WORD(ViewParameters, skyHorizon) + 2,
            PFVOX_WORD(ViewParameters, skyGround) + 2};
}

TEST_F(LayoutTest, ShadersReadMembersWhereCppWroteThem) {
    std::vector<std::uint32_t> numbers(1024);
    for (std::uint32_t i = 0; i < numbers.size(); ++i) numbers[i] = kFirst + i;
    const std::vector<std::uint32_t> expected = expectedWords();
    std::vector<std::uint32_t> found(expected.size());

    struct Push {
        glm::uvec2 numbers;
        glm::uvec2 found;
    };
    PFVOX_ASSERT_VALUE(const gpu::Buffer, input, device().createBuffer(4 * numbers.size(), "numbers"));
    PFVOX_ASSERT_VALUE(const gpu::Buffer, output, device().createBuffer(4 * found.size(), "found"));
    PFVOX_ASSERT_VALUE(const gpu::Program, program,
                       device().createProgram(shaders::kLayoutCheck, sizeof(Push), "layout check"));
    ASSERT_TRUE(device().upload(input, 0, std::as_bytes(std::span(numbers))));
    const Push push{input.addressWords(), output.addressWords()};
    const gpu::Dispatch dispatch{.program = &program, .pushConstants = gpu::bytesOf(push)};
    ASSERT_TRUE(device().run({&dispatch, 1}));
    ASSERT_TRUE(device().download(output, 0, std::as_writable_bytes(std::span(found))));
    EXPECT_EQ(found, expected);
}

}  // namespace
}  // namespace pfvox::test
