#include "scenes/garment_format/garment_schema.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/temporary_folder.h"

namespace toile::test {

using garment_format::garment_key_tables;
using garment_format::garment_schema;

namespace {

std::string text_of(const std::string& file)
{
    return bytes_of(std::filesystem::path(TOILE_SOURCE_DIR) / file);
}

TEST(GarmentSchema, MatchesTheCommittedFile)
{
    EXPECT_EQ(garment_schema(), text_of("docs/reference/toile_garment.schema.json"))
        << "write it anew with: toile schema --garment > docs/reference/toile_garment.schema.json";
}

TEST(GarmentSchema, IsTheSourceOfTheCommittedKeyTables)
{
    EXPECT_EQ(garment_key_tables(), text_of("docs/reference/garment_keys.md"))
        << "write them anew with: toile schema --garment --tables > docs/reference/garment_keys.md";
}

TEST(GarmentSchema, ListsRangesDefaultsAndWords)
{
    const auto schema = nlohmann::json::parse(garment_schema());
    EXPECT_EQ(schema["required"], (nlohmann::json{"toile_garment", "patterns"}));
    const auto& panel = schema["properties"]["panels"]["additionalProperties"]["properties"];
    EXPECT_EQ(panel["copies"]["default"], 1);
    EXPECT_EQ(panel["place"]["properties"]["wrap"]["default"], true);
    EXPECT_EQ(panel["place"]["required"], nlohmann::json{"at"});
    const auto& seam = schema["properties"]["seams"]["items"]["properties"];
    EXPECT_EQ(seam["join"]["enum"], (nlohmann::json{"start-end", "start-start"}));
    EXPECT_EQ(seam["a"]["items"]["type"], "string");
}

} // namespace
} // namespace toile::test
