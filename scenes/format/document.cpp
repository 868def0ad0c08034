#include "scenes/format/document.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <set>
#include <system_error>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/extension.h"

namespace toile::scene_format {

namespace {

/// Levels of nesting of a document. Functions that call themselves per level, such as as_written(), need a
/// bound.
constexpr int kMaxDepth = 64;

/// [bytes] Scenes with the longest lists of vertices are smaller; devices such as /dev/zero never end.
constexpr size_t kMaxFileSize = 64'000'000;

/// Message of nlohmann without its "line 3, column 5: ".
std::string fact_of(const Json::exception& error)
{
    std::string what = error.what();
    const size_t column = what.find("column ");
    const size_t colon = column == std::string::npos ? std::string::npos : what.find(": ", column);
    const size_t after_id = what.find("] ");
    std::replace_if(
        what.begin(), what.end(), [](unsigned char c) { return c >= 0x80; }, '?');
    if (colon != std::string::npos)
        return what.substr(colon + 2);
    return after_id == std::string::npos ? what : what.substr(after_id + 2);
}

std::string between_quotes(const std::string& text)
{
    const size_t first = text.find('\'') + 1;
    return text.substr(first, text.rfind('\'') - first);
}

/// Line and column of a byte of the text, counted from 1 as in editors: "3:5".
std::string line_and_column(const std::string& text, size_t byte)
{
    const size_t end = std::min(byte > 0 ? byte - 1 : 0, text.size());
    const auto line = 1 + std::count(text.begin(), text.begin() + long(end), '\n');
    const size_t newline = end == 0 ? std::string::npos : text.rfind('\n', end - 1);
    const size_t column = newline == std::string::npos ? end + 1 : end - newline;
    return std::to_string(line) + ":" + std::to_string(column);
}

/// Control characters, which keys and names may contain, as spaces.
std::string one_line(std::string text)
{
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < 0x20; }, ' ');
    return text;
}

/// Advice for a file that does not exist.
std::string remedy_for(const std::string& path)
{
    if (path.find('\\') != std::string::npos)
        return "write / between folders, also for Windows";
    if (path.starts_with('~') || path.find('$') != std::string::npos)
        return "~ and variables are not expanded, except ${TOILE_DATA_DIR}";
    return "paths are relative to the folder of the file that names them";
}

/// Why text that is often taken for JSON is none; empty for other text.
/// @param at  position of the character where reading ended
std::string habit_in(const std::string& text, size_t at)
{
    if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
        return "it is in UTF-16; save it in UTF-8";
    if (at < text.size() && text[at] == '/')
        return "JSON has no comments; remove them, or write a \"description\"";
    const size_t before = at == 0 ? std::string::npos : text.find_last_not_of(" \t\r\n", at - 1);
    if (at < text.size() && (text[at] == '}' || text[at] == ']') && before != std::string::npos &&
        text[before] == ',')
        return std::string("a comma stands before ") + text[at] + "; remove it";
    return "";
}

/// Data folder: the environment variable, else the folder chosen at build time.
std::string data_folder()
{
    const char* chosen = std::getenv("TOILE_DATA_DIR");
    return chosen != nullptr && *chosen != '\0' ? chosen : TOILE_DATA_DIR;
}

} // namespace

std::string read_document(const std::filesystem::path& file, const std::string& kind)
{
    if (std::filesystem::is_directory(file))
        throw InvalidInput(file.string() + ": is a folder; name a " + kind + " (.json)");
    std::ifstream stream(file, std::ios::binary);
    if (!stream)
        throw InvalidInput(file.string() + ": can't be opened; check the path and its permissions");
    std::string text;
    std::array<char, 65536> block;
    do {
        stream.read(block.data(), block.size());
        text.append(block.data(), size_t(stream.gcount()));
        if (text.size() > kMaxFileSize)
            throw InvalidInput(file.string() + ": is larger than 64 MB; name a " + kind + " (.json)");
    } while (stream);
    return text;
}

void Document::refuse(const std::string& key_path, const std::string& why) const
{
    throw InvalidInput(source_.string() + ": " + one_line((key_path.empty() ? "" : key_path + ": ") + why));
}

Json Document::parse(const std::string& text) const
{
    // One set of keys per open object detects a repeated key.
    std::vector<std::set<std::string>> open;
    const auto check_event = [&](int depth, Json::parse_event_t event, Json& parsed) {
        if (depth > kMaxDepth)
            refuse("",
                   "is nested deeper than " + std::to_string(kMaxDepth) + " levels; a scene has at most 6");
        if (event == Json::parse_event_t::object_start)
            open.emplace_back();
        else if (event == Json::parse_event_t::object_end)
            open.pop_back();
        else if (event == Json::parse_event_t::key && !open.back().insert(parsed.get<std::string>()).second)
            refuse("", "the key " + as_written(parsed) + " is given twice in one object; keep one of them");
        return true;
    };
    try {
        return Json::parse(text, check_event);
    } catch (const Json::parse_error& error) {
        const std::string habit = habit_in(text, error.byte > 0 ? error.byte - 1 : 0);
        throw InvalidInput(source_.string() + ":" + line_and_column(text, error.byte) +
                           ": not valid JSON: " + (habit.empty() ? fact_of(error) : habit));
    } catch (const Json::out_of_range& error) { // "number overflow parsing '1e400'"
        const std::string number = between_quotes(fact_of(error));
        throw InvalidInput(source_.string() + ":" + line_and_column(text, text.find(number) + 1) + ": " +
                           number + " is out of range; give a smaller number");
    } catch (const Json::exception& error) {
        refuse("", "not valid JSON: " + fact_of(error));
    }
}

std::string Document::expanded(const std::string& text, const std::string& key_path) const
{
    static const std::string kVariable = "${TOILE_DATA_DIR}";
    std::string expanded = text;
    if (const size_t at = text.find(kVariable); at != std::string::npos) {
        const std::string folder = data_folder();
        if (!std::filesystem::is_directory(folder))
            refuse(key_path, "the data folder " + as_written(folder) +
                                 " does not exist; set the environment variable TOILE_DATA_DIR");
        expanded.replace(at, kVariable.size(), folder);
    }
    if (expanded.find("${") != std::string::npos)
        refuse(key_path, as_written(text) + " names an unknown variable; only " + kVariable + " is known");
    return expanded;
}

std::filesystem::path Document::path_of(const std::string& text, const std::string& key_path) const
{
    return source_.parent_path() / expanded(text, key_path);
}

std::filesystem::path Document::existing_file(const std::string& text, const std::string& key_path) const
{
    const std::filesystem::path file = path_of(text, key_path);
    const std::filesystem::path normal = file.lexically_normal();
    std::error_code unreachable;
    if (!std::filesystem::exists(file, unreachable))
        refuse(key_path, "the file " + as_written(normal.string()) + " does not exist; " +
                             remedy_for(expanded(text, key_path)));
    if (!std::filesystem::is_regular_file(file, unreachable))
        refuse(key_path, as_written(normal.string()) + " is a folder, pipe or device; name a file");
    // Behind a symbolic link, ".." leads elsewhere than its text says.
    return std::filesystem::equivalent(file, normal, unreachable) ? normal : file;
}

std::string as_written(const Json& value)
{
    constexpr size_t kLongest = 120;
    std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (text.size() > kLongest)
        text = text.substr(0, kLongest) + "...";
    return text;
}

std::string below(const std::string& key_path, const std::string& key)
{
    return key_path.empty() ? key : key_path + "." + key;
}

std::string below(const std::string& key_path, size_t index)
{
    return key_path + "[" + std::to_string(index) + "]";
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates)
{
    const std::string near = nearest_word(word, candidates);
    return near.empty() ? "" : "; did you mean " + as_written(near) + "?";
}

void check_extension(const Document& document, const std::string& key_path, const std::filesystem::path& file,
                     const std::vector<std::string>& known)
{
    if (std::find(known.begin(), known.end(), lower_case_extension(file)) == known.end())
        document.refuse(key_path, as_written(file.string()) + " is of an unknown format; use " +
                                      enumerate(known, "or"));
}

std::string enumerate(const std::vector<std::string>& words, const std::string& conjunction)
{
    std::string text;
    for (size_t i = 0; i < words.size(); ++i) {
        if (i > 0)
            text += i + 1 == words.size() ? " " + conjunction + " " : ", ";
        text += words[i];
    }
    return text;
}

} // namespace toile::scene_format
