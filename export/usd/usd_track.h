#pragma once

#include <string>
#include <vector>

#include "export/usd/usd_file.h"

namespace toile::exports {

/// An attribute that changes from frame to frame, and its latest samples.
class UsdTrack {
public:
    /// @param declaration  type and name, as "point3f[] points"
    /// @param width        floats of a tuple
    /// @param metadata     in parentheses, or empty
    UsdTrack(std::string declaration, int width, std::string metadata = "");

    void add(std::vector<float> sample);
    void drop_all_but_last();

    /// Type and name only: samples are in clips.
    void declare(UsdFile& file, const std::string& indent) const;
    /// Samples of a stage; one value without a time if they are the same.
    /// @param times  [samples] time codes
    void write(UsdFile& file, const std::string& indent, const std::vector<double>& times) const;
    /// All samples, as clips need them.
    void write_all(UsdFile& file, const std::string& indent, const std::vector<double>& times) const;

private:
    void write_samples(UsdFile& file, const std::string& indent, const std::vector<double>& times,
                       size_t first, size_t end) const;

    std::string declaration_, metadata_;
    int width_;
    std::vector<std::vector<float>> samples_;
};

} // namespace toile::exports
