#include "scenes/garment_format/garment_schema.h"

#include "scenes/format/schema/key_tables.h"
#include "scenes/format/schema/schema_writer.h"
#include "scenes/garment_format/describe_garment.h"

namespace toile::garment_format {

std::string garment_schema()
{
    return scene_format::document_schema(
        GarmentFile(), "Toile garment",
        "A garment: panels of sewing patterns and how they are sewn. Paths relative to the file.");
}

std::string garment_key_tables()
{
    return scene_format::key_tables(garment_schema(), "Keys of a garment file",
                                    "toile schema --garment --tables");
}

} // namespace toile::garment_format
