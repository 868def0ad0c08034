#include "avatars/import/gltf_uri.h"

#include <array>
#include <cctype>

namespace toile::avatars {

namespace {

constexpr int kNoDigit = -1;

/// Value of each character as a digit of base 64. [256]
std::array<int, 256> base64_digits()
{
    std::array<int, 256> digits{};
    digits.fill(kNoDigit);
    constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < kAlphabet.size(); ++i)
        digits[static_cast<unsigned char>(kAlphabet[i])] = int(i);
    return digits;
}

int hex_digit(char letter)
{
    if (letter >= '0' && letter <= '9')
        return letter - '0';
    const int lower = std::tolower(static_cast<unsigned char>(letter));
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : kNoDigit;
}

/// Length of a scheme at the start, "https" of "https://x"; 0 without one.
size_t scheme_length(std::string_view uri)
{
    size_t length = 0;
    while (length < uri.size() && (std::isalnum(static_cast<unsigned char>(uri[length])) != 0 ||
                                   uri[length] == '+' || uri[length] == '-' || uri[length] == '.'))
        ++length;
    return length < uri.size() && uri[length] == ':' ? length : 0;
}

} // namespace

bool is_data_uri(std::string_view uri) { return uri.starts_with("data:"); }

std::vector<unsigned char> decode_data_uri(const GltfValue& uri)
{
    static const std::array<int, 256> kDigits = base64_digits();
    static constexpr std::string_view kMark = ";base64,";
    std::string_view text = uri.text();
    const size_t mark = text.substr(0, text.find(',') + 1).rfind(kMark);
    if (mark == std::string_view::npos)
        uri.refuse("embedded data must be in base64: data:application/octet-stream;base64,...");
    text.remove_prefix(mark + kMark.size());
    for (int padding = 0; padding < 2 && text.ends_with('='); ++padding)
        text.remove_suffix(1);

    // Four digits of 6 bits are three bytes.
    std::vector<unsigned char> bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    unsigned bits = 0;
    int bit_count = 0;
    for (size_t i = 0; i < text.size(); ++i) {
        const int digit = kDigits[static_cast<unsigned char>(text[i])];
        if (digit == kNoDigit)
            uri.refuse("character " + std::to_string(mark + kMark.size() + i) + " is not base64");
        bits = (bits << 6) | unsigned(digit);
        bit_count += 6;
        if (bit_count >= 8) {
            bit_count -= 8;
            bytes.push_back(static_cast<unsigned char>(bits >> bit_count));
        }
    }
    return bytes;
}

std::string decode_path(const GltfValue& uri)
{
    const std::string& text = uri.text();
    if (const size_t scheme = scheme_length(text); scheme > 0)
        uri.refuse("'" + text.substr(0, scheme) +
                   ":' is not read; give the path of a file beside this one, or embed the data");
    std::string path;
    for (size_t i = 0; i < text.size(); ++i) {
        const int high = i + 2 < text.size() ? hex_digit(text[i + 1]) : kNoDigit;
        const int low = i + 2 < text.size() ? hex_digit(text[i + 2]) : kNoDigit;
        if (text[i] == '%' && high != kNoDigit && low != kNoDigit) {
            path += char(16 * high + low);
            i += 2;
        } else {
            path += text[i];
        }
    }
    if (path.find('\0') != std::string::npos)
        uri.refuse("a path has no zero byte");
    return path;
}

} // namespace toile::avatars
