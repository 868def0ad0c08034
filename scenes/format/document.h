#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>

/// Text of a scene or garment file and key paths within it, for error messages.
namespace toile::scene_format {

using Json = nlohmann::json;

/// A document and its source. Every error about it is one line: "file: key path: what; remedy".
class Document {
public:
    /// @param source  the file's name; paths in the document are relative to its folder
    explicit Document(std::filesystem::path source) : source_(std::move(source)) {}

    const std::filesystem::path& source() const { return source_; }

    /// @param key_path  a key path such as cloths[0].fabric; empty for the whole document
    [[noreturn]] void refuse(const std::string& key_path, const std::string& why) const;

    /// Parses JSON.
    /// @throws InvalidInput with line and column for a syntax error, and with the key for one given twice in
    ///         an object, which JSON parsers accept silently.
    Json parse(const std::string& text) const;

    /// Path named by `text` at `key_path`: ${TOILE_DATA_DIR} replaced, relative paths made relative to the
    /// document's folder.
    /// @throws InvalidInput if the data folder is missing or another variable is named.
    std::filesystem::path path_of(const std::string& text, const std::string& key_path) const;

    /// Path of a file, likewise.
    /// @throws InvalidInput if it is missing, too
    std::filesystem::path existing_file(const std::string& text, const std::string& key_path) const;

private:
    std::string expanded(const std::string& text, const std::string& key_path) const;

    std::filesystem::path source_;
};

/// Text of a document.
/// @param kind  "scene file" or another, for messages
/// @throws InvalidInput if the file can't be opened, is a folder, or larger than any document
std::string read_document(const std::filesystem::path& file, const std::string& kind);

/// A value as written in the file, on one line and cut after a few words, for error messages.
std::string as_written(const Json& value);

/// `key_path` and a key below it: cloths[0] and fabric give cloths[0].fabric.
std::string below(const std::string& key_path, const std::string& key);
/// `key_path` and an index: cloths and 0 give cloths[0].
std::string below(const std::string& key_path, size_t index);

/// "; did you mean "fabric"?", or empty if no candidate is similar.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates);

/// @throws InvalidInput unless a file has one of these extensions, in capitals or not
void check_extension(const Document& document, const std::string& key_path, const std::filesystem::path& file,
                     const std::vector<std::string>& known);

/// "a, b and c" for messages.
std::string enumerate(const std::vector<std::string>& words, const std::string& conjunction);

} // namespace toile::scene_format
