#include "courtyard.hpp"

#include "models.hpp"

namespace pfvox::demo {

namespace {

constexpr int kGroundTop = 4;

/// Layers of the scene, in the order of the file.
enum LayerId { kTerrain, kBuildings, kPlants, kFurniture, kLights, kDraft };

/// Collects models and places them by name.
class SceneBuilder {
  public:
    int addModel(Canvas canvas) {
        scene.models.push_back(std::move(canvas));
        return static_cast<int>(scene.models.size()) - 1;
    }

    Node placed(const std::string& name, int model, glm::ivec3 corner, LayerId layer,
                Rotation rotation = {}) const {
        Node node = placeAtCorner(name, model, scene.models[static_cast<std::size_t>(model)].size(), corner,
                                  rotation);
        node.layer = layer;
        return node;
    }

    void place(const std::string& name, int model, glm::ivec3 corner, LayerId layer, Rotation rotation = {}) {
        scene.nodes.push_back(placed(name, model, corner, layer, rotation));
    }

    VoxScene scene;
};

/// Four arches in a row along the left side of the court, open towards its middle.
Node arcade(const SceneBuilder& builder, int arch, const std::string& name, Rotation rotation) {
    Node group{.name = name, .model = -1, .children = {}, .rotation = rotation, .layer = kBuildings};
    for (int i = 0; i < 4; ++i) {
        group.children.push_back(builder.placed("arch " + std::to_string(i + 1), arch,
                                                {-63, -63 + 24 * i, kGroundTop}, kBuildings, turned(1)));
    }
    return group;
}

void placeBuildings(SceneBuilder& builder, const DemoPalette& p) {
    const int house = builder.addModel(makeHouse(p));
    const int tower = builder.addModel(makeTower(p));
    const int stairs = builder.addModel(makeStairs(p));
    const int arch = builder.addModel(makeArch(p));
    builder.place("house", house, {-34, 19, kGroundTop}, kBuildings);
    builder.place("tower", tower, {-63, 31, kGroundTop}, kBuildings);
    builder.place("stairs", stairs, {34, 17, kGroundTop}, kBuildings);
    builder.scene.nodes.push_back(arcade(builder, arch, "left arcade", {}));
    builder.scene.nodes.push_back(arcade(builder, arch, "right arcade", mirroredX()));
    builder.place("arch as first drawn", arch, {-12, -80, kGroundTop}, kDraft);
}

void placeFurniture(SceneBuilder& builder, const DemoPalette& p) {
    const int fountain = builder.addModel(makeFountain(p));
    const int statue = builder.addModel(makeStatue(p));
    const int bench = builder.addModel(makeBench(p));
    const int ball = builder.addModel(makeMetalBall(p));
    const int glassBlock = builder.addModel(makeGlassBlock(p));
    const int table = builder.addModel(makeTable(p));
    builder.place("fountain", fountain, {-20, -35, kGroundTop}, kFurniture);
    builder.place("armillary sphere", statue, {-2, 25, kGroundTop + kHouseHeight}, kFurniture);
    builder.place("bench west", bench, {-39, -21, kGroundTop}, kFurniture, turned(1));
    builder.place("bench east", bench, {30, -21, kGroundTop}, kFurniture, turned(3));
    builder.place("metal ball", ball, {10, 40, kGroundTop + 1}, kFurniture);
    builder.place("glass block", glassBlock, {-26, 44, kGroundTop + 1}, kFurniture, turned(2));
    builder.place("table", table, {-9, 46, kGroundTop + 1}, kFurniture);
}

void placePlants(SceneBuilder& builder, const DemoPalette& p) {
    const int tree = builder.addModel(makeTree(p, 301));
    const int blossom = builder.addModel(makeBlossomTree(p));
    const int planter = builder.addModel(makePlanter(p));
    builder.place("tree", tree, {-49, -62, kGroundTop}, kPlants);
    builder.place("tree", tree, {13, -62, kGroundTop}, kPlants, turned(2));
    builder.place("blossom", blossom, {-46, -8, kGroundTop}, kPlants);
    builder.place("blossom", blossom, {15, -10, kGroundTop}, kPlants, turned(3));
    for (const int x : {-29, -7, 13}) {
        builder.place("planter on the roof", planter, {x, 21, kGroundTop + kHouseHeight}, kPlants);
    }
}

void placeLights(SceneBuilder& builder, const DemoPalette& p) {
    const int lamp = builder.addModel(makeLamp(p));
    for (const int x : {-21, 10}) {
        builder.place("lamp", lamp, {x, 7, kGroundTop}, kLights);
        builder.place("lamp", lamp, {x, -58, kGroundTop}, kLights);
    }
}

}  // namespace

VoxScene makeCourtyard(const DemoPalette& palette) {
    SceneBuilder builder;
    builder.scene.layers = {{"terrain"},   {"buildings"}, {"plants"},
                            {"furniture"}, {"lights"},    {"draft", true}};
    builder.place("ground", builder.addModel(makeGround(palette)), {-63, -63, 0}, kTerrain);
    placeBuildings(builder, palette);
    placeFurniture(builder, palette);
    placePlants(builder, palette);
    placeLights(builder, palette);
    return std::move(builder.scene);
}

}  // namespace pfvox::demo
