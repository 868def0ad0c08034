#include "quadrature2d/geodesic_embedding.h"

#include <algorithm>
#include <limits>
#include <queue>

#include <Eigen/Eigenvalues>

#include "core/compute/parallel.h"

namespace toile::quadrature2d {

namespace {

/// Number of landmarks, from which all distances are measured. More resolve finer branches; 48 resolve a
/// garment's panels.
constexpr int kLandmarks = 48;

/// Eigenvalue relative to the largest below which a direction is metric error, not shape [-].
constexpr double kMinExtent = 1e-3;

/// Distance between pieces relative to the largest piece [-].
constexpr double kApart = 100.0;

constexpr double kFar = std::numeric_limits<double>::infinity();

/// Neighbours of every vertex with their distances.
class MetricGraph {
public:
    MetricGraph(int vertex_count, View<const MetricEdge> metric) : first_(vertex_count + 1, 0)
    {
        for (const MetricEdge& edge : metric) {
            ++first_[edge.a + 1];
            ++first_[edge.b + 1];
        }
        for (int v = 0; v < vertex_count; ++v)
            first_[v + 1] += first_[v];
        ends_.resize(first_.back());
        std::vector<int> next(first_.begin(), first_.end() - 1);
        for (const MetricEdge& edge : metric) {
            ends_[next[edge.a]++] = {edge.b, edge.length};
            ends_[next[edge.b]++] = {edge.a, edge.length};
        }
    }

    bool is_alone(int v) const { return first_[v] == first_[v + 1]; }

    /// Length of the shortest path to every vertex [m], kFar if there is none. [Dijkstra 1959]
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

/// Landmarks of a piece and the distances from them.
struct Landmarks {
    std::vector<int> vertex;
    std::vector<std::vector<double>> distance; ///< [landmarks][n]
};

/// Chooses each landmark as the vertex farthest from the earlier ones. [Gonzalez 1985]
Landmarks choose_landmarks(const MetricGraph& graph, const std::vector<int>& piece)
{
    Landmarks marks;
    std::vector<double> nearest(piece.size(), kFar);
    int next = piece.front();
    double radius = kFar;
    while (int(marks.vertex.size()) < kLandmarks && radius > 0.0) {
        marks.vertex.push_back(next);
        marks.distance.push_back(graph.distances_from(next));
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

/// Embeds the landmarks by classical scaling, then every vertex by its distances from them.
void embed_piece(const Landmarks& marks, const std::vector<int>& piece, std::vector<EmbeddedPoint>& points)
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

    for (int k = 0; k < std::min<int>(count, EmbeddedPoint::RowsAtCompileTime); ++k) {
        const double extent = eigen.eigenvalues()[count - 1 - k];
        if (!(extent > kMinExtent * largest))
            break;
        const Eigen::VectorXd weight = eigen.eigenvectors().col(count - 1 - k) / std::sqrt(extent);
        parallel_for(kCpu, "quadrature/embedding", int(piece.size()), [&](int i) {
            double coordinate = 0.0;
            for (int j = 0; j < count; ++j)
                coordinate -= 0.5 * weight[j] * (std::pow(marks.distance[j][piece[i]], 2) - mean[j]);
            points[piece[i]][k] = coordinate;
        });
    }
}

} // namespace

std::vector<EmbeddedPoint> geodesic_embedding(int vertex_count, View<const MetricEdge> metric)
{
    const MetricGraph graph(vertex_count, metric);
    std::vector<EmbeddedPoint> points(vertex_count, EmbeddedPoint::Zero());
    std::vector<unsigned char> is_embedded(vertex_count, 0);
    std::vector<std::vector<int>> pieces;
    double largest = 0.0;
    for (int v = 0; v < vertex_count; ++v) {
        if (is_embedded[v])
            continue;
        if (graph.is_alone(v)) {
            pieces.push_back({v});
            continue;
        }
        const std::vector<double> reached = graph.distances_from(v);
        std::vector<int> piece;
        for (int u = 0; u < vertex_count; ++u)
            if (reached[u] < kFar) {
                piece.push_back(u);
                is_embedded[u] = 1;
                largest = std::max(largest, reached[u]);
            }
        embed_piece(choose_landmarks(graph, piece), piece, points);
        pieces.push_back(std::move(piece));
    }
    for (size_t k = 0; k < pieces.size(); ++k)
        for (const int v : pieces[k])
            points[v][0] += kApart * (largest > 0.0 ? largest : 1.0) * double(k);
    return points;
}

} // namespace toile::quadrature2d
