#include "scenes/format/field.h"
#include "scenes/format/schema/schema.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include <nlohmann/json.hpp>

#include "garment/fabric/fabric.h"

namespace toile::test {

using namespace garment;
using namespace scenes;

namespace {

std::string text_of(const std::string& file)
{
    std::ifstream stream(std::string(TOILE_SOURCE_DIR) + "/" + file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(SceneSchema, MatchesTheCommittedFile)
{
    EXPECT_EQ(scene_schema(), text_of("docs/reference/toile.schema.json"))
        << "write it anew with: toile schema > docs/reference/toile.schema.json";
}

TEST(SceneSchema, IsTheSourceOfTheCommittedKeyTables)
{
    EXPECT_EQ(scene_key_tables(), text_of("docs/reference/keys.md"))
        << "write them anew with: toile schema --tables > docs/reference/keys.md";
}

TEST(SceneSchema, ListsRangesDefaultsAndExclusiveKeys)
{
    const auto schema = nlohmann::json::parse(scene_schema());
    const auto& frames = schema["properties"]["frames"];
    EXPECT_EQ(frames["type"], "integer");
    EXPECT_EQ(frames["minimum"], 1);
    EXPECT_FALSE(frames.contains("default"));
    const auto& solver = schema["properties"]["solver"];
    EXPECT_EQ(solver["additionalProperties"], false);
    EXPECT_EQ(solver["properties"]["tolerance"]["exclusiveMinimum"], 0.0);
    EXPECT_EQ(solver["properties"]["method"]["enum"],
              (nlohmann::json(scene_format::words_of<scene::SolverMethod>())));
    EXPECT_EQ(solver["properties"]["outer"]["enum"], (nlohmann::json(scene_format::words_of<OuterMethod>())));
    EXPECT_FALSE(solver["properties"]["outer"].contains("default"));
    EXPECT_EQ(solver["properties"]["quality"]["default"], "standard");
    EXPECT_EQ(schema["properties"]["cloths"]["items"]["oneOf"].size(), 4u);
    EXPECT_EQ(schema["required"], (nlohmann::json{"toile", "frames"}));
}

TEST(SceneDocs, NameEveryFabricPreset)
{
    const std::string page = text_of("docs/guide/scenes.md");
    for (const Fabric& fabric : fabric_presets())
        EXPECT_NE(page.find(fabric.name), std::string::npos) << fabric.name;
}

/// Expects a description of every object and every key below `schema`.
void expect_described(const nlohmann::json& schema, const std::string& path)
{
    if (schema.contains("properties"))
        for (const auto& [key, member] : schema["properties"].items()) {
            EXPECT_FALSE(member.value("description", "").empty()) << path << key;
            expect_described(member, path + key + ".");
        }
    if (schema.contains("items"))
        expect_described(schema["items"], path);
}

TEST(SceneSchema, DescribesEveryKey) { expect_described(nlohmann::json::parse(scene_schema()), ""); }

} // namespace
} // namespace toile::test
