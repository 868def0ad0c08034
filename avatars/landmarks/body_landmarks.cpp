#include "avatars/landmarks/body_landmarks.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/base/error.h"

namespace toile::avatars {

namespace {

/// Where the landmark of that name is kept; null for a name that none has.
Vec3* landmark_of(BodyLandmarks& landmarks, const std::string& name)
{
    const std::map<std::string, Vec3*> places{{"front", &landmarks.front},
                                              {"neck_top", &landmarks.neck_top},
                                              {"neck_base", &landmarks.neck_base},
                                              {"crotch", &landmarks.crotch},
                                              {"left_shoulder", &landmarks.arm[kLeft].shoulder},
                                              {"left_wrist", &landmarks.arm[kLeft].wrist},
                                              {"left_leg_top", &landmarks.leg[kLeft].top},
                                              {"left_ankle", &landmarks.leg[kLeft].ankle},
                                              {"right_shoulder", &landmarks.arm[kRight].shoulder},
                                              {"right_wrist", &landmarks.arm[kRight].wrist},
                                              {"right_leg_top", &landmarks.leg[kRight].top},
                                              {"right_ankle", &landmarks.leg[kRight].ankle}};
    const auto place = places.find(name);
    return place == places.end() ? nullptr : place->second;
}

const std::vector<std::string> kNames{"front",          "neck_top",    "neck_base",     "crotch",
                                      "left_shoulder",  "left_wrist",  "left_leg_top",  "left_ankle",
                                      "right_shoulder", "right_wrist", "right_leg_top", "right_ankle"};

Vec3 vector_of(const nlohmann::json& value, const std::string& place)
{
    Vec3 x = Vec3::Constant(NAN);
    if (value.is_array() && value.size() == 3)
        for (int k = 0; k < 3; ++k)
            if (value[size_t(k)].is_number())
                x[k] = value[size_t(k)].get<double>();
    if (!is_in_range(x))
        throw InvalidInput(place + ": is " + value.dump() + "; give [x, y, z] in metres");
    return x;
}

} // namespace

GivenLandmarks by_name(const BodyLandmarks& landmarks)
{
    BodyLandmarks copy = landmarks;
    GivenLandmarks named;
    for (const std::string& name : kNames)
        named[name] = *landmark_of(copy, name);
    return named;
}

GivenLandmarks read_landmarks(const std::filesystem::path& file)
{
    std::ifstream stream(file);
    if (!stream)
        throw InvalidInput(file.string() + ": can't be read; name a JSON file of landmarks");
    const nlohmann::json json = nlohmann::json::parse(stream, nullptr, false);
    if (!json.is_object())
        throw InvalidInput(file.string() + ": is no JSON object; write {\"crotch\": [x, y, z], ...}");
    GivenLandmarks given;
    for (const auto& [name, value] : json.items()) {
        if (std::find(kNames.begin(), kNames.end(), name) == kNames.end()) {
            const std::string nearest = nearest_word(name, kNames);
            throw InvalidInput(file.string() + ": unknown landmark '" + name + "'; " +
                               (nearest.empty() ? "known are " + kNames[1] + ", " + kNames[2] + ", ..."
                                                : "did you mean '" + nearest + "'?"));
        }
        given[name] = vector_of(value, file.string() + ": " + name);
        if (name == "front" && Vec3(given[name].x(), 0.0, given[name].z()).isZero(1e-9))
            throw InvalidInput(file.string() + ": front: is vertical; give a horizontal direction");
    }
    return given;
}

bool are_complete(const GivenLandmarks& given)
{
    return given.size() == kNames.size() || (given.size() + 1 == kNames.size() && !given.contains("front"));
}

void replace(BodyLandmarks& landmarks, const GivenLandmarks& given)
{
    for (const auto& [name, x] : given)
        *landmark_of(landmarks, name) = x;
    landmarks.front = (landmarks.front - landmarks.up.dot(landmarks.front) * landmarks.up).normalized();
}

} // namespace toile::avatars
