#include "pipeline/bodies/bone_weights.hpp"

#include <algorithm>
#include <numeric>

#include <Eigen/Geometry>

#include "collision/exact/orientation.hpp"
#include "collision/geometry/factorisations.hpp"
#include "collision/search/bvh.hpp"

namespace selvedge {
namespace {

constexpr double leaf_length = 0.5;  // length of a bone without an end, relative to its parent's
constexpr double same = 1 + 1e-6;    // distances within this ratio count as equal, as for bones that share a joint
constexpr double least_weight = 1e-3;
constexpr double least_cotangent = 1e-3;  // of an edge, so that heat spreads over bad triangles too
constexpr int at_once = 2000;             // lines of sight per batch, to bound the memory for their pairs

struct Bone {
  int joint;
  Vec3 from, to;
};

std::vector<Bone> bones_between(const Points& joints, const std::vector<int>& parents) {
  std::vector<Bone> bones;
  std::vector<char> has_child(parents.size(), 0);
  for (std::size_t j = 1; j < parents.size(); ++j) {
    bones.push_back({parents[j], row(joints, parents[j]), row(joints, static_cast<int>(j))});
    has_child[parents[j]] = 1;
  }
  for (std::size_t j = 1; j < parents.size(); ++j) {
    if (has_child[j]) continue;
    const Vec3 end = row(joints, static_cast<int>(j));
    bones.push_back({static_cast<int>(j), end, end + leaf_length * (end - row(joints, parents[j]))});
  }
  return bones;
}

Vec3 nearest_on(const Bone& bone, const Vec3& p) {
  const Vec3 along = bone.to - bone.from;
  const double length = along.squaredNorm();
  return length > 0 ? Vec3(bone.from + std::clamp((p - bone.from).dot(along) / length, 0.0, 1.0) * along) : bone.from;
}

struct Sight {
  int vertex, bone;
};

bool crosses(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  if (orient3d(a, b, c, p) * orient3d(a, b, c, q) >= 0) return false;
  const int u = orient3d(p, q, a, b), v = orient3d(p, q, b, c), w = orient3d(p, q, c, a);
  return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
}

// Tests lines of sight from vertices to the nearest points of bones for crossings with the surface.
class Hiding {
 public:
  Hiding(const Surface& surface, const Points& rest, const std::vector<Bone>& bones)
      : surface_(surface), rest_(rest), bones_(bones) {
    std::vector<Box> boxes;
    triangle_boxes(surface, rest, rest, 0, boxes);
    tree_ = build_bvh(boxes);
  }

  std::vector<char> operator()(const std::vector<Sight>& lines) const {
    std::vector<char> hidden(lines.size(), 0);
    for (std::size_t begin = 0; begin < lines.size(); begin += at_once) {
      const std::size_t end = std::min(lines.size(), begin + at_once);
      Points from(end - begin, 3), to(end - begin, 3);
      for (std::size_t k = begin; k < end; ++k) {
        const Vec3 p = row(rest_, lines[k].vertex);
        from.row(static_cast<Eigen::Index>(k - begin)) = p.transpose();
        to.row(static_cast<Eigen::Index>(k - begin)) = nearest_on(bones_[lines[k].bone], p).transpose();
      }
      std::vector<Box> boxes;
      vertex_boxes(from, to, 0, boxes);
      std::vector<std::pair<int, int>> pairs;
      cross_pairs(build_bvh(boxes), tree_, pairs);
      for (const auto& [line, triangle] : pairs) {
        const auto corners = surface_.triangles.row(triangle);
        const std::size_t k = begin + static_cast<std::size_t>(line);
        if (hidden[k] || (corners.array() == lines[k].vertex).any()) continue;
        hidden[k] = crosses(row(from, line), row(to, line), row(rest_, corners[0]), row(rest_, corners[1]),
                            row(rest_, corners[2]));
      }
    }
    return hidden;
  }

 private:
  const Surface& surface_;
  const Points& rest_;
  const std::vector<Bone>& bones_;
  Bvh tree_;
};

// The heat source of a vertex: the joints of the nearest visible bones, in equal parts, and their distance.
struct Source {
  std::vector<int> joints;
  double distance = 0;
};

std::vector<Source> sources(const Surface& surface, const Points& rest, const std::vector<Bone>& bones) {
  const int n = surface.vertex_count, count = static_cast<int>(bones.size());
  Eigen::MatrixXd distance(n, count);
  std::vector<std::vector<int>> order(static_cast<std::size_t>(n));
  for (int v = 0; v < n; ++v) {
    for (int b = 0; b < count; ++b) distance(v, b) = (row(rest, v) - nearest_on(bones[b], row(rest, v))).norm();
    auto& nearest = order[v];
    nearest.resize(bones.size());
    std::iota(nearest.begin(), nearest.end(), 0);
    std::stable_sort(nearest.begin(), nearest.end(), [&](int a, int b) { return distance(v, a) < distance(v, b); });
  }
  const auto take = [&](int v, int rank) {
    const auto& nearest = order[v];
    Source source{{}, distance(v, nearest[rank])};
    for (const int b : nearest)
      if (distance(v, b) <= same * source.distance && distance(v, b) * same >= source.distance)
        source.joints.push_back(bones[b].joint);
    return source;
  };

  std::vector<Source> found(static_cast<std::size_t>(n));
  const Hiding hiding(surface, rest, bones);
  std::vector<int> waiting(static_cast<std::size_t>(n));
  std::iota(waiting.begin(), waiting.end(), 0);
  for (int rank = 0; rank < count && !waiting.empty(); ++rank) {
    std::vector<Sight> lines;
    for (const int v : waiting) lines.push_back({v, order[v][rank]});
    const std::vector<char> hidden = hiding(lines);
    std::vector<int> still;
    for (std::size_t k = 0; k < waiting.size(); ++k) {
      if (hidden[k])
        still.push_back(waiting[k]);
      else
        found[waiting[k]] = take(waiting[k], rank);
    }
    waiting.swap(still);
  }
  std::vector<char> warm(static_cast<std::size_t>(surface.component_count), 0);
  const auto piece = [&](int v) { return static_cast<std::size_t>(surface.component[v]); };
  for (int v = 0; v < n; ++v) warm[piece(v)] = warm[piece(v)] || !found[v].joints.empty();
  for (const int v : waiting)
    if (!warm[piece(v)]) found[v] = take(v, 0);
  return found;
}

// Minus the cotangent Laplacian times the vertices' areas. Sets `areas`: a third of the area of the triangles round
// each.
Eigen::SparseMatrix<double> conduction(const Surface& surface, const Points& rest, Eigen::VectorXd& areas) {
  std::vector<Eigen::Triplet<double>> entries;
  areas = Eigen::VectorXd::Zero(surface.vertex_count);
  for (const auto& t : surface.triangles.rowwise())
    for (int k = 0; k < 3; ++k) {
      const int at = t[k], i = t[(k + 1) % 3], j = t[(k + 2) % 3];
      const Vec3 a = row(rest, i) - row(rest, at), b = row(rest, j) - row(rest, at);
      const double twice_area = a.cross(b).norm();
      areas[at] += twice_area / 6;
      const double weight = std::max(least_cotangent, twice_area > 0 ? 0.5 * a.dot(b) / twice_area : 0);
      entries.emplace_back(i, i, weight);
      entries.emplace_back(j, j, weight);
      entries.emplace_back(i, j, -weight);
      entries.emplace_back(j, i, -weight);
    }
  Eigen::SparseMatrix<double> matrix(surface.vertex_count, surface.vertex_count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

SkinWeights bone_weights(const Surface& surface, const Points& rest, const Points& joints,
                         const std::vector<int>& parents) {
  const std::vector<Source> from = sources(surface, rest, bones_between(joints, parents));
  Eigen::VectorXd areas;
  Eigen::SparseMatrix<double> matrix = conduction(surface, rest, areas);
  // Heat would be infinite for vertices on a bone or at one place: distances are at least a tenth of the spacing.
  const auto spread = std::max<Eigen::Index>(1, (areas.array() > 0).count());
  const double spacing = std::sqrt(areas.sum() / static_cast<double>(spread));
  Eigen::MatrixXd heat = Eigen::MatrixXd::Zero(surface.vertex_count, joints.rows());
  for (int v = 0; v < surface.vertex_count; ++v) {
    const Source& source = from[v];
    if (source.joints.empty()) continue;
    const double near = std::max(source.distance, 0.1 * spacing);
    const double rate = std::max(areas[v], 1e-9 * spacing * spacing) / (near * near);
    matrix.coeffRef(v, v) += rate;
    for (const int j : source.joints) heat(v, j) += rate / static_cast<double>(source.joints.size());
  }
  const Eigen::MatrixXd warmth = solve_symmetric(matrix, heat);
  std::vector<Eigen::Triplet<double>> entries;
  for (int v = 0; v < warmth.rows(); ++v) {
    double sum = 0;
    for (int j = 0; j < warmth.cols(); ++j) sum += warmth(v, j) >= least_weight ? warmth(v, j) : 0;
    for (int j = 0; j < warmth.cols(); ++j)
      if (warmth(v, j) >= least_weight) entries.emplace_back(v, j, warmth(v, j) / sum);
  }
  return from_entries(warmth.rows(), warmth.cols(), entries);
}

}  // namespace selvedge
