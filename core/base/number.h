#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace toile {

/// Decimal number that the whole word is, with or without a sign; 0 where double precision has no number as
/// small. Nothing for other words, and for infinite values.
std::optional<double> number_in(std::string_view word);

/// The same for whole numbers.
std::optional<std::int64_t> whole_number_in(std::string_view word);

/// A number, or a quotient of two such as the frame rate 24000/1001.
std::optional<double> quotient_in(std::string_view word);

/// The shortest text that reads back as the same number, whatever the locale: 0.1, 1e+20, inf, nan.
std::string shortest_text(double value);
std::string shortest_text(float value);

/// Three digits of a number, for messages: 0.0123, 12.3, 1.23e+04. In the C locale always.
std::string short_text(double value);

} // namespace toile
