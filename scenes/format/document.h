#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>

/// The text of a scene file and where in it we are: what error messages need.
namespace toile::scene_format {

using Json = nlohmann::json;

/// Where a document comes from. Every complaint about it reads "file: place: what; remedy", one line.
class Document {
public:
    /// @param source  the file's name; paths in the document are relative to its folder
    explicit Document(std::filesystem::path source) : source_(std::move(source)) {}

    const std::filesystem::path& source() const { return source_; }

    /// @param place  a key path such as cloths[0].fabric; empty for the whole document
    [[noreturn]] void refuse(const std::string& place, const std::string& why) const;

    /// Parses JSON.
    /// @throws InvalidInput with line and column for a syntax error, with the key for one given twice in
    ///         an object, which JSON parsers otherwise pass over in silence.
    Json parse(const std::string& text) const;

    /// The file that `text` at `place` names: ${TOILE_DATA_DIR} replaced, relative paths made relative to the
    /// document's folder.
    /// @throws InvalidInput when the file (or the data folder) is missing or another variable is named.
    std::filesystem::path existing_file(const std::string& text, const std::string& place) const;

private:
    std::filesystem::path source_;
};

/// A value as it stands in the file, on one line and cut after a few words, for error messages.
std::string as_written(const Json& value);

/// `place` and a key below it: cloths[0] and fabric give cloths[0].fabric.
std::string below(const std::string& place, const std::string& key);
/// `place` and an index: cloths and 0 give cloths[0].
std::string below(const std::string& place, size_t index);

/// "; did you mean "fabric"?" or nothing when no word is near.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates);

/// "a, b and c" for messages.
std::string enumerate(const std::vector<std::string>& words, const std::string& conjunction);

} // namespace toile::scene_format
