#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include "large_sources.hpp"

namespace pfvox::bench {

void writeFogBall(const std::filesystem::path& file) {
    constexpr int kRadius = 400;
    openvdb::initialize();
    auto grid = openvdb::FloatGrid::create(0.0f);
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    // Column by column along z, which sparseFill() would do for boxes only; constant nodes become tiles.
    auto accessor = grid->getAccessor();
    for (int x = -kRadius; x < kRadius; x += 8)
        for (int y = -kRadius; y < kRadius; y += 8)
            for (int z = -kRadius; z < kRadius; z += 8) {
                const openvdb::Coord corner(x, y, z);
                const auto reach = [](int c) { return std::max(c * c, (c + 7) * (c + 7)); };
                if (reach(x) + reach(y) + reach(z) <= kRadius * kRadius) {
                    grid->tree().addTile(1, corner, 1.0f, true);
                    continue;
                }
                for (int i = 0; i < 512; ++i) {
                    const openvdb::Coord p = corner.offsetBy(i >> 6, (i >> 3) & 7, i & 7);
                    if (p.x() * p.x() + p.y() * p.y() + p.z() * p.z() <= kRadius * kRadius) {
                        accessor.setValueOn(p, 1.0f);
                    }
                }
            }
    grid->pruneGrid();
    openvdb::io::File(file.string()).write({grid});
}

}  // namespace pfvox::bench
