#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

/// Runs a fuzz target without libFuzzer: replay FOLDER MUTANTS. Every file of the folder, and so many random
/// changes of each, the same in every run.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

std::string contents_of(const std::filesystem::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// One to four changes: a byte, a piece cut out or doubled, an end cut off, or a word that parsers trip over.
std::string mutant_of(std::string text, std::mt19937& random)
{
    static const std::vector<std::string> kWords{"-1",   "0",    "1e999", "nan",  "4294967296", "2147483647",
                                                 "\"\"", "null", "[]",    "{}",   "\\",         "\xff\xfe",
                                                 "[[[[", "1e38", "-0.0",  "\n\n", "true",       "1e-320"};
    const auto below = [&](std::size_t bound) {
        return std::uniform_int_distribution<std::size_t>(0, bound > 0 ? bound - 1 : 0)(random);
    };
    const std::size_t changes = 1 + below(4);
    for (std::size_t k = 0; k < changes && !text.empty(); ++k) {
        const std::size_t at = below(text.size()),
                          length = 1 + below(std::min<std::size_t>(64, text.size() - at));
        switch (below(5)) {
        case 0:
            text[at] = char(below(256));
            break;
        case 1:
            text.erase(at, length);
            break;
        case 2:
            text.insert(at, text.substr(at, length));
            break;
        case 3:
            text.resize(at);
            break;
        default:
            text.replace(at, std::min<std::size_t>(length, 4), kWords[below(kWords.size())]);
        }
    }
    return text;
}

void run(const std::string& input)
{
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
}

} // namespace

int main(int count, char** arguments)
{
    if (count != 3) {
        std::fprintf(stderr, "usage: %s FOLDER MUTANTS\n", arguments[0]);
        return 2;
    }
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(arguments[1]))
        files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    const long mutants = std::atol(arguments[2]);
    std::mt19937 random(1);
    for (const std::filesystem::path& file : files) {
        const std::string text = contents_of(file);
        run(text);
        for (long k = 0; k < mutants; ++k)
            run(mutant_of(text, random));
    }
    std::printf("%zu files, %ld mutants of each\n", files.size(), mutants);
    return files.empty() ? 1 : 0;
}
