#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>

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

void writeFarApart(const std::filesystem::path& file) {
    openvdb::initialize();
    auto grid = openvdb::MaskGrid::create();
    grid->setName("far");
    grid->tree().setValueOn(openvdb::Coord(0, 0, 0));
    grid->tree().setValueOn(openvdb::Coord(1'000'000'000, 0, 0));
    openvdb::io::File(file.string()).write({grid});
}

void writeHugeShell(const std::filesystem::path& file) {
    constexpr double kInner = 1999.5;
    constexpr double kOuter = 2000.5;
    constexpr int kReach = 2000;
    openvdb::initialize();
    auto grid = openvdb::MaskGrid::create();
    grid->setName("shell");
    auto accessor = grid->getAccessor();
    for (int x = -kReach; x <= kReach; ++x)
        for (int y = -kReach; y <= kReach; ++y) {
            const double across = double(x) * x + double(y) * y;
            if (across > kOuter * kOuter) continue;
            const int first = static_cast<int>(std::ceil(std::sqrt(std::max(0.0, kInner * kInner - across))));
            const int last = static_cast<int>(std::sqrt(kOuter * kOuter - across));
            for (int z = first; z <= last; ++z) {
                accessor.setValueOn(openvdb::Coord(x, y, z));
                accessor.setValueOn(openvdb::Coord(x, y, -z));
            }
        }
    openvdb::io::File(file.string()).write({grid});
}

}  // namespace pfvox::bench
