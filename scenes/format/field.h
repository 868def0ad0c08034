#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "scenes/format/scene.h"

/// Types used by describe.h: ranges of numbers, words of enumerations, alternatives.
namespace toile::scene_format {

using namespace scene; // the described structs

/// Allowed values of a number, or of every number in a vector.
struct Range {
    double lower;
    double upper;
    const char* unit = "";
    bool above_lower = false; ///< lower itself is excluded

    bool contains(double value) const
    {
        return value <= upper && (above_lower ? value > lower : value >= lower);
    }
};

/// "above 0 and at most 100 m"
std::string to_sentence(const Range& range);

constexpr Range between(double lower, double upper, const char* unit = "") { return {lower, upper, unit}; }
/// A positive number, up to a bound that only a mistake (wrong unit, typing error) exceeds.
constexpr Range above_zero(double upper, const char* unit = "") { return {0.0, upper, unit, true}; }

/// Range of positions. Its limit of a kilometre reveals files in an undeclared unit other than metres.
inline constexpr Range kPosition{-1000.0, 1000.0, "m"};
inline constexpr Range kAngle{-3600.0, 3600.0, "degrees"};
inline constexpr Range kTime{0.0, 86400.0, "s"};
inline constexpr Range kColor{0.0, 1.0};
inline constexpr Range kResolution{0.0005, 1.0, "m"};
inline constexpr Range kStiffness{0.0, 1e8, "N/m", true};
inline constexpr Range kThickness{0.0, 0.05, "m", true};
inline constexpr Range kStiffnessFactor{0.0, 1000.0, "", true};
inline constexpr Range kPressure{-1e5, 1e5, "Pa"};
inline constexpr Range kFoldAngle{-180.0, 180.0, "degrees"};
inline constexpr Range kFoldStiffness{0.0, 100.0, "N", true};

/// One member of a variant and the key that chooses it.
template <typename T>
struct Alternative {
    using Type = T;
    const char* key;
    const char* help;
    Range range{0.0, 0.0}; ///< used when T is a list of numbers
};

/// Words of an enumeration in scene files.
template <typename E>
struct Words;

template <>
struct Words<SelfContact> {
    static constexpr std::array<std::pair<const char*, SelfContact>, 2> kAll{
        {{"separate", SelfContact::Separate}, {"keep", SelfContact::Keep}}};
};

template <>
struct Words<LengthUnit> {
    static constexpr std::array<std::pair<const char*, LengthUnit>, 4> kAll{{{"m", LengthUnit::Metre},
                                                                             {"cm", LengthUnit::Centimetre},
                                                                             {"mm", LengthUnit::Millimetre},
                                                                             {"in", LengthUnit::Inch}}};
};

template <>
struct Words<ExportUnit> {
    static constexpr std::array<std::pair<const char*, ExportUnit>, 2> kAll{
        {{"m", ExportUnit::Metre}, {"cm", ExportUnit::Centimetre}}};
};

template <>
struct Words<ExportAttribute> {
    static constexpr std::array<std::pair<const char*, ExportAttribute>, 3> kAll{
        {{"strain", ExportAttribute::Strain},
         {"gap", ExportAttribute::Gap},
         {"panel", ExportAttribute::Panel}}};
};

template <>
struct Words<UpAxis> {
    static constexpr std::array<std::pair<const char*, UpAxis>, 2> kAll{{{"y", UpAxis::Y}, {"z", UpAxis::Z}}};
};

template <>
struct Words<Print> {
    static constexpr std::array<std::pair<const char*, Print>, 3> kAll{
        {{"plain", Print::Plain}, {"checker", Print::Checker}, {"stripes", Print::Stripes}}};
};

template <>
struct Words<PaintChannel> {
    static constexpr std::array<std::pair<const char*, PaintChannel>, 3> kAll{
        {{"red", PaintChannel::Red}, {"green", PaintChannel::Green}, {"blue", PaintChannel::Blue}}};
};

template <>
struct Words<RestFrom> {
    static constexpr std::array<std::pair<const char*, RestFrom>, 2> kAll{
        {{"shape", RestFrom::Shape}, {"uv", RestFrom::Uv}}};
};

template <>
struct Words<SolverMethod> {
    static constexpr std::array<std::pair<const char*, SolverMethod>, 11> kAll{
        {{"auto", SolverMethod::Auto},
         {"direct", SolverMethod::Direct},
         {"quadrature", SolverMethod::Quadrature},
         {"multigrid", SolverMethod::Multigrid},
         {"subspace", SolverMethod::Subspace},
         {"chebyshev", SolverMethod::Chebyshev},
         {"a-jacobi", SolverMethod::AJacobi},
         {"jacobi-pcg", SolverMethod::JacobiPcg},
         {"paper", SolverMethod::Paper},
         {"xpbd", SolverMethod::Xpbd},
         {"vbd", SolverMethod::Vbd}}};
};

template <>
struct Words<OuterMethod> {
    static constexpr std::array<std::pair<const char*, OuterMethod>, 5> kAll{
        {{"newton", OuterMethod::Newton},
         {"lbfgs", OuterMethod::Lbfgs},
         {"local-global", OuterMethod::LocalGlobal},
         {"anderson", OuterMethod::Anderson},
         {"newton-pcg", OuterMethod::NewtonPcg}}};
};

template <>
struct Words<scene::Quality> {
    static constexpr std::array<std::pair<const char*, scene::Quality>, 3> kAll{
        {{"preview", scene::Quality::Preview},
         {"standard", scene::Quality::Standard},
         {"final", scene::Quality::Final}}};
};

template <>
struct Words<Integrator> {
    static constexpr std::array<std::pair<const char*, Integrator>, 2> kAll{
        {{"bdf2", Integrator::Bdf2}, {"implicit-euler", Integrator::ImplicitEuler}}};
};

template <>
struct Words<StepStop> {
    static constexpr std::array<std::pair<const char*, StepStop>, 2> kAll{
        {{"error", StepStop::Error}, {"move", StepStop::Move}}};
};

template <>
struct Words<ContactPreconditioner> {
    static constexpr std::array<std::pair<const char*, ContactPreconditioner>, 5> kAll{
        {{"block", ContactPreconditioner::Block},
         {"exact", ContactPreconditioner::Exact},
         {"sherman-morrison", ContactPreconditioner::ShermanMorrison},
         {"chebyshev", ContactPreconditioner::Chebyshev},
         {"paper", ContactPreconditioner::Paper}}};
};

/// All words of an enumeration, in the order of their documentation.
template <typename E>
std::vector<std::string> words_of()
{
    std::vector<std::string> words;
    words.reserve(Words<E>::kAll.size());
    for (const auto& [word, value] : Words<E>::kAll)
        words.emplace_back(word);
    return words;
}

template <typename E>
const char* word_of(E value)
{
    return std::find_if(Words<E>::kAll.begin(), Words<E>::kAll.end(),
                        [&](const auto& entry) { return entry.second == value; })
        ->first;
}

/// @param word  one of words_of()
template <typename E>
E value_of(const std::string& word)
{
    return std::find_if(Words<E>::kAll.begin(), Words<E>::kAll.end(),
                        [&](const auto& entry) { return entry.first == word; })
        ->second;
}

} // namespace toile::scene_format
