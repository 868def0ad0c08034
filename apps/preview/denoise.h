#pragma once

#include <vector>

#include <Eigen/Core>

namespace toile::preview {

/// A pixel with the noise of its light paths.
struct NoisyPixel {
    Eigen::Vector3f color = Eigen::Vector3f::Zero(); ///< display-linear RGB
    float variance = 0.0f;                           ///< of color, sum over its channels
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    Eigen::Vector3f position = Eigen::Vector3f::Zero(); ///< from the camera [m]
    Eigen::Vector3f paint = Eigen::Vector3f::Zero();    ///< mean colour of the surface, if it is painted [-]
    int surface = kNoSurface;                           ///< what all paths of the pixel met

    /// Background, or several surfaces: the pixel stays as it is, and no other takes of it.
    static constexpr int kNoSurface = -1;
};

/// Averages pixels with neighbours that differ by no more than their noise, on the same surface, of similar
/// normal, near the same plane: a wavelet of four passes whose taps are 1, 2, 4 and 8 pixels apart.
///
///   c_p <- sum_q w_pq c_q / sum_q w_pq         [Dammertz et al. 2010, section 2; variance: Schied et al.
///   2017]
///
/// Borders of surfaces, of prints, of colours in paint and of shadows are kept. Variances of single pixels
/// say little, so those of the pixels around are averaged first.
/// @param pixels  [height x width]
void remove_noise(std::vector<NoisyPixel>& pixels, int width, int height);

} // namespace toile::preview
