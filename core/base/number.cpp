#include "core/base/number.h"

#include <array>
#include <charconv>
#include <clocale>
#include <cmath>
#include <cstdlib>
#include <string>

namespace toile {

namespace {

/// The word without a plus sign, which std::from_chars() does not know.
std::string_view without_plus(std::string_view word)
{
    return word.size() > 1 && word[0] == '+' && word[1] != '-' ? word.substr(1) : word;
}

/// Infinity or 0, for a word that std::from_chars() finds out of range. In the C locale: in others the
/// decimal point may be a comma.
double magnitude_beyond_range(std::string_view word)
{
    static const ::locale_t c_locale = ::newlocale(LC_ALL_MASK, "C", nullptr);
    return ::strtod_l(std::string(word).c_str(), nullptr, c_locale);
}

template <typename T>
std::string shortest_text_of(T value)
{
    if (std::isnan(value))
        return "nan"; // without a sign
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value);
    return {text.data(), end.ptr};
}

} // namespace

std::optional<double> number_in(std::string_view word)
{
    word = without_plus(word);
    const char* const last = word.data() + word.size();
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), last, value);
    if (end != last || error == std::errc::invalid_argument)
        return std::nullopt;
    if (error == std::errc::result_out_of_range) // too large or too small
        value = magnitude_beyond_range(word);
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::optional<std::int64_t> whole_number_in(std::string_view word)
{
    word = without_plus(word);
    const char* const last = word.data() + word.size();
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), last, value);
    return end == last && error == std::errc{} ? std::optional(value) : std::nullopt;
}

std::optional<double> quotient_in(std::string_view word)
{
    const size_t slash = word.find('/');
    const std::optional<double> numerator = number_in(word.substr(0, slash));
    if (slash == std::string_view::npos || !numerator)
        return numerator;
    const std::optional<double> denominator = number_in(word.substr(slash + 1));
    if (!denominator || !std::isfinite(*numerator / *denominator))
        return std::nullopt;
    return *numerator / *denominator;
}

std::string shortest_text(double value) { return shortest_text_of(value); }

std::string shortest_text(float value) { return shortest_text_of(value); }

std::string short_text(double value)
{
    std::array<char, 32> text{};
    const auto end =
        std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 3);
    return {text.data(), end.ptr};
}

} // namespace toile
