#include "quadrature2d/geodesic_places.h"

#include <algorithm>
#include <limits>
#include <queue>

#include <Eigen/Eigenvalues>

#include "core/backend/parallel.h"

namespace toile {

namespace {

/// Points that all distances are measured from. More resolve finer branches; 48 see a garment's panels.
constexpr int kLandmarks = 48;

/// Eigenvalue relative to the largest below which a direction is metric error, not shape [-].
constexpr double kLeastExtent = 1e-3;

/// Distance between pieces over the largest piece's size [-].
constexpr double kApart = 100.0;

constexpr double kFar = std::numeric_limits<double>::infinity();

/// Neighbours of every vertex and how far they are.
class Ways {
public:
    Ways(int vertex_count, View<const MetricEdge> metric) : first_(vertex_count + 1, 0)
    {
        for (const MetricEdge& way : metric) {
            ++first_[way.a + 1];
            ++first_[way.b + 1];
        }
        for (int v = 0; v < vertex_count; ++v)
            first_[v + 1] += first_[v];
        ends_.resize(first_.back());
        std::vector<int> next(first_.begin(), first_.end() - 1);
        for (const MetricEdge& way : metric) {
            ends_[next[way.a]++] = {way.b, way.length};
            ends_[next[way.b]++] = {way.a, way.length};
        }
    }

    bool is_alone(int v) const { return first_[v] == first_[v + 1]; }

    /// Length of the shortest path to every vertex [m], kFar where there is none. [Dijkstra 1959]
    std::vector<double> distances_from(int source) const
    {
        std::vector<double> distance(first_.size() - 1, kFar);
        using Item = std::pair<double, int>;
        std::priority_queue<Item, std::vector<Item>, std::greater<>> open;
        distance[source] = 0.0;
        open.emplace(0.0, source);
        while (!open.empty()) {
            const auto [so_far, v] = open.top();
            open.pop();
            if (so_far > distance[v])
                continue;
            for (int k = first_[v]; k < first_[v + 1]; ++k)
                if (const double length = so_far + ends_[k].length; length < distance[ends_[k].vertex]) {
                    distance[ends_[k].vertex] = length;
                    open.emplace(length, ends_[k].vertex);
                }
        }
        return distance;
    }

private:
    struct End {
        int vertex = 0;
        double length = 0.0;
    };
    std::vector<int> first_;
    std::vector<End> ends_;
};

/// Distances of a piece's vertices from its landmarks, [landmarks] rows.
struct Landmarks {
    std::vector<int> vertex;
    std::vector<std::vector<double>> distance; ///< [landmarks][n]
};

/// Each landmark is the vertex farthest from those before. [Gonzalez 1985]
Landmarks choose_landmarks(const Ways& ways, const std::vector<int>& piece)
{
    Landmarks marks;
    std::vector<double> nearest(piece.size(), kFar);
    int next = piece.front();
    double radius = kFar;
    while (int(marks.vertex.size()) < kLandmarks && radius > 0.0) {
        marks.vertex.push_back(next);
        marks.distance.push_back(ways.distances_from(next));
        radius = 0.0;
        for (size_t i = 0; i < piece.size(); ++i) {
            nearest[i] = std::min(nearest[i], marks.distance.back()[piece[i]]);
            if (nearest[i] > radius) {
                radius = nearest[i];
                next = piece[i];
            }
        }
    }
    return marks;
}

/// Classical scaling of the landmarks, then every vertex by its distances from them.
void place_piece(const Landmarks& marks, const std::vector<int>& piece, std::vector<Place>& places)
{
    const int count = int(marks.vertex.size());
    Eigen::MatrixXd squares(count, count);
    for (int i = 0; i < count; ++i)
        for (int j = 0; j < count; ++j)
            squares(i, j) = std::pow(marks.distance[i][marks.vertex[j]], 2);
    const Eigen::VectorXd mean = squares.rowwise().mean();
    const Eigen::MatrixXd centred =
        -0.5 * ((squares.colwise() - mean).rowwise() - mean.transpose()).array() - 0.5 * mean.mean();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(centred);
    const double largest = eigen.eigenvalues()[count - 1];

    for (int k = 0; k < std::min<int>(count, Place::RowsAtCompileTime); ++k) {
        const double extent = eigen.eigenvalues()[count - 1 - k];
        if (!(extent > kLeastExtent * largest))
            break;
        const Eigen::VectorXd weight = eigen.eigenvectors().col(count - 1 - k) / std::sqrt(extent);
        parallel_for(kCpu, "quadrature/places", int(piece.size()), [&](int i) {
            double coordinate = 0.0;
            for (int j = 0; j < count; ++j)
                coordinate -= 0.5 * weight[j] * (std::pow(marks.distance[j][piece[i]], 2) - mean[j]);
            places[piece[i]][k] = coordinate;
        });
    }
}

} // namespace

std::vector<Place> geodesic_places(int vertex_count, View<const MetricEdge> metric)
{
    const Ways ways(vertex_count, metric);
    std::vector<Place> places(vertex_count, Place::Zero());
    std::vector<unsigned char> is_placed(vertex_count, 0);
    std::vector<std::vector<int>> pieces;
    double largest = 0.0;
    for (int v = 0; v < vertex_count; ++v) {
        if (is_placed[v])
            continue;
        if (ways.is_alone(v)) {
            pieces.push_back({v});
            continue;
        }
        const std::vector<double> reached = ways.distances_from(v);
        std::vector<int> piece;
        for (int u = 0; u < vertex_count; ++u)
            if (reached[u] < kFar) {
                piece.push_back(u);
                is_placed[u] = 1;
                largest = std::max(largest, reached[u]);
            }
        place_piece(choose_landmarks(ways, piece), piece, places);
        pieces.push_back(std::move(piece));
    }
    for (size_t k = 0; k < pieces.size(); ++k)
        for (const int v : pieces[k])
            places[v][0] += kApart * (largest > 0.0 ? largest : 1.0) * double(k);
    return places;
}

} // namespace toile
