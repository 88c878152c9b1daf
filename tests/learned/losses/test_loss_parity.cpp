#include <catch2/catch.hpp>
#include <numeric>

#include "collision/geometry/distance.hpp"
#include "learned/losses/objective.hpp"
#include "tests/learned/loss_scenes.hpp"
#include "tests/learned/parity_pack.hpp"

namespace selvedge::test_loss_parity {
namespace {

double number(const Npz& npz, const std::string& name) { return npz.numbers(name).values[0]; }

// What stays the same in a file of the authors' losses.
struct LossFile {
  std::string name;
  Npz npz;
  bool hood = false;
  Surface body;
  LossGarment garment;
  std::vector<std::string> states, losses;
  NpyArray<double> values, gradients;
};

LossFile load_losses(const std::string& name) {
  LossFile file{name, parity::open(name), name.starts_with("hood"), {}, {}, {}, {}, {}, {}};
  const Points rest = parity::points(file.npz, file.hood ? "rest_pos" : "cloth_rest_pos");
  const Surface cloth = parity::surface(file.npz, "faces", static_cast<int>(rest.rows()));
  const Points body = parity::points(file.npz, file.hood ? "frame0_body_pos" : "body_pos");
  file.body = parity::surface(file.npz, "body_faces", static_cast<int>(body.rows()));
  std::vector<char> pinned(static_cast<std::size_t>(rest.rows()), 0);
  if (!file.hood) {
    const std::vector<int> types = parity::integers(file.npz, "cloth_vertex_type");
    for (std::size_t v = 0; v < pinned.size(); ++v) pinned[v] = types[v] == pinned_vertex;
  }
  const std::vector<double> mass = file.npz.numbers("mass").values, area = file.npz.numbers("face_area").values;
  constexpr double thickness = 4.7e-4;  // of the authors [m]
  VertexMaterial material;
  material.density = std::accumulate(mass.begin(), mass.end(), 0.0) / std::accumulate(area.begin(), area.end(), 0.0);
  material.lame_mu = thickness * number(file.npz, "lame_mu");
  material.lame_lambda = thickness * number(file.npz, "lame_lambda");
  material.bending = number(file.npz, "bending_coeff");
  file.garment = make_loss_garment(cloth, rest, pinned, material);
  for (std::size_t v = 0; v < mass.size(); ++v) CHECK(file.garment.mass[v] == Approx(mass[v]).epsilon(1e-5));
  CHECK(file.garment.hinges.size() * 2 == parity::integers(file.npz, "hinge_edges").size());
  file.states = file.npz.texts("state_names").values;
  file.losses = file.npz.texts("loss_names").values;
  file.values = file.npz.numbers("values_f64");
  file.gradients = file.npz.numbers("gradients");
  return file;
}

// One of the states.
struct LossState {
  Points x, velocity, predicted, body_previous, body_now, body_next;
  std::vector<ClothPair> repulsion;
  double timestep = 0;
  bool is_init = false;

  LossInputs inputs(const LossFile& file) const {
    LossInputs in;
    in.garment = &file.garment;
    in.x = &x;
    in.velocity = &velocity;
    in.predicted = &predicted;
    in.body = &file.body;
    in.body_previous = &body_previous;
    in.body_now = &body_now;
    in.body_next = &body_next;
    in.repulsion = repulsion;
    in.timestep = timestep;
    in.is_initial = is_init;
    return in;
  }
};

LossState load_state(const LossFile& file, std::size_t state) {
  const auto at = static_cast<std::size_t>(file.garment.surface.vertex_count) * 3 * state;
  const std::string frame = file.hood ? "frame" + std::to_string(parity::integers(file.npz, "frame")[state]) + "_" : "";
  const auto points_at = [&](const char* name) { return parity::points(file.npz, frame + name); };
  LossState s;
  s.x = points_at("cloth_pos");
  s.velocity = points_at("cloth_velocity");
  const NpyArray<double> predicted = file.npz.numbers("pred_pos");
  s.predicted = Eigen::Map<const Points>(predicted.values.data() + at, s.x.rows(), 3);
  s.body_previous = points_at("body_prev_pos");
  s.body_now = points_at("body_pos");
  s.body_next = points_at("body_target_pos");
  s.timestep = number(file.npz, frame + "timestep");
  if (file.hood) return s;
  s.is_init = number(file.npz, "is_init") != 0;
  const std::vector<int> from = parity::integers(file.npz, "repulsion_nodes_from"),
                         to = parity::integers(file.npz, "repulsion_faces_to");
  for (std::size_t i = 0; i < from.size(); ++i) s.repulsion.push_back({from[i], to[i]});
  return s;
}

// The authors' crossings of the predicted cloth: edges 0 to 2 are the first face's, 3 to 5 the second's; a loop end is
// stored as the first face's edge that begins at the common vertex.
Segments their_crossings(const LossFile& file, std::size_t state) {
  const std::string prefix = "state" + std::to_string(state) + "_contour_";
  const std::vector<int> faces = parity::integers(file.npz, prefix + "face_pairs"),
                         types = parity::integers(file.npz, prefix + "type_ids");
  const NpyArray<double> loops = file.npz.numbers(prefix + "loop");
  const Surface& cloth = file.garment.surface;
  Segments found;
  for (std::size_t i = 0; i < faces.size(); i += 2) {
    Segment segment{{0, 0}, {faces[i], faces[i + 1]}, {}};
    for (std::size_t end = 0; end < 2; ++end) {
      const int type = types[i + end], own = type < 3 ? faces[i] : faces[i + 1],
                other = type < 3 ? faces[i + 1] : faces[i];
      if (loops.values[i + end] != 0) {
        segment.end[end] = ~cloth.triangles(own, type % 3);
        continue;
      }
      segment.end[end] = static_cast<int>(found.crossings.size());
      found.crossings.push_back({0, cloth.triangle_edges(own, type % 3), 0, other, 0, {}});
    }
    found.segments.push_back(segment);
  }
  return found;
}

// In a file's state: every term alone, with the weight that is inside the authors' values.
LossOptions options_at(const LossFile& file, std::size_t state) {
  LossOptions options = file.hood ? hood_losses() : testing::contourcraft_final_losses();
  const auto fix = [](LossRamp& ramp, double weight) { ramp = {weight, weight}; };
  if (file.hood) {
    fix(options.collision.weight, file.npz.numbers("collision_weight").values[state]);
    return options;
  }
  const NpyArray<double> weights = file.npz.numbers("weights");
  const auto weight_of = [&](const std::string& loss) {
    const auto at = std::ranges::find(file.losses, loss) - file.losses.begin();
    return weights.values[state * file.losses.size() + static_cast<std::size_t>(at)];
  };
  fix(options.collision.weight, weight_of("collision_penalty"));
  fix(options.repulsion.weight, weight_of("repulsion"));
  fix(options.contours.weight, weight_of("icontour"));
  return options;
}

LossMatches matches_at(const LossFile& file, const LossState& s, std::size_t state, const LossOptions& options) {
  LossSearch search;
  find_matches(s.inputs(file), options, search);
  LossMatches matches = search.matches;
  if (file.hood) return matches;
  const Segments theirs = their_crossings(file, state);
  if (options.contours.weight.to != 0) CHECK(matches.crossings.segments.size() == theirs.segments.size());
  matches.crossings = theirs;
  // Ties between faces are the authors' to decide (parity README, 23).
  const std::vector<int> from = parity::integers(file.npz, "collision_nodes_from"),
                         to = parity::integers(file.npz, "collision_faces_to");
  std::vector<int> faces(s.x.rows(), -1);
  for (std::size_t i = 0; i < from.size(); ++i) faces[static_cast<std::size_t>(from[i])] = to[i];
  const auto distance = [&](std::size_t v, int f) {
    const auto corner = [&](int k) { return row(s.body_now, file.body.triangles(f, k)); };
    return std::sqrt(point_triangle(row(s.x, static_cast<int>(v)), corner(0), corner(1), corner(2)).squared_distance);
  };
  for (std::size_t v = 0; v < faces.size(); ++v) {
    CHECK((faces[v] < 0) == (matches.collision_face[v] < 0));
    if (faces[v] >= 0 && matches.collision_face[v] >= 0)
      CHECK(distance(v, faces[v]) == Approx(distance(v, matches.collision_face[v])).margin(1e-7));
  }
  matches.collision_face = faces;
  return matches;
}

const std::map<std::string, std::string> our_names{{"stretching_energy", "stretching"},
                                                   {"bending_energy", "bending"},
                                                   {"inertia", "inertia"},
                                                   {"gravitational_energy", "gravity"},
                                                   {"collision_penalty", "collision"},
                                                   {"friction_energy", "friction"},
                                                   {"repulsion", "repulsion"},
                                                   {"icontour", "contours"}};

LossOptions only(const LossOptions& all, const std::string& name) {
  LossOptions one = all;
  const std::map<std::string, LossRamp*> ramps{{"stretching", &one.stretching},
                                               {"bending", &one.bending},
                                               {"inertia", &one.inertia},
                                               {"gravity", &one.gravity},
                                               {"collision", &one.collision.weight},
                                               {"friction", &one.friction.weight},
                                               {"repulsion", &one.repulsion.weight},
                                               {"contours", &one.contours.weight}};
  for (const auto& [other, ramp] : ramps)
    if (other != name) *ramp = {0, 0};
  return one;
}

// Vertices that have slid less than 1e-5 m beside the body are left out: there friction's derivative jumps (14).
bool slides(const LossFile& file, const LossState& s, const LossMatches& matches, int v) {
  struct Plane {
    Vec3 centroid, normal;
  };
  const auto plane = [&](const Points& body, const std::vector<int>& faces) {
    const auto corner = file.body.triangles.row(faces[static_cast<std::size_t>(v)]);
    const Vec3 a = row(body, corner(0)), b = row(body, corner(1)), c = row(body, corner(2));
    return Plane{(a + b + c) / 3, (b - a).cross(c - a).normalized()};
  };
  const Plane start = plane(s.body_previous, matches.friction_before),
              moved = plane(s.body_now, matches.friction_before), end = plane(s.body_now, matches.friction_after);
  const Vec3 slid = row(s.predicted, v) - (row(s.x, v) + (moved.centroid - start.centroid));
  const Vec3 normal = (start.normal + end.normal) / 2;
  return (slid - slid.dot(normal) * normal).norm() >= 1e-5;
}

void check_loss(const LossFile& file, const LossState& s, const LossMatches& matches, std::size_t state,
                std::size_t loss, const LossOptions& options) {
  const std::string name = our_names.at(file.losses[loss]);
  INFO(file.name << ", " << file.states[state] << ", " << name);
  Points gradient = Points::Zero(s.x.rows(), 3);
  const std::vector<LossTerm> terms = add_losses(s.inputs(file), only(options, name), matches, &gradient);
  const double value = terms.empty() ? 0 : terms[0].value;
  if (!terms.empty()) CHECK(terms[0].name == name);
  const double theirs = file.values.values[state * file.losses.size() + loss];
  CHECK(std::abs(value - theirs) <= 5e-6 * std::abs(theirs));
  const auto begin = (state * file.losses.size() + loss) * static_cast<std::size_t>(s.x.rows()) * 3;
  const Points expected = Eigen::Map<const Points>(file.gradients.values.data() + begin, s.x.rows(), 3);
  double worst = 0;
  int left_out = 0;
  for (Eigen::Index v = 0; v < gradient.rows(); ++v)
    if (name != "friction" || slides(file, s, matches, static_cast<int>(v)))
      worst = std::max(worst, (gradient.row(v) - expected.row(v)).cwiseAbs().maxCoeff());
    else
      ++left_out;
  CHECK(left_out < gradient.rows() / 2);
  CHECK(worst <= 1e-4 * expected.cwiseAbs().maxCoeff());
}

}  // namespace

TEST_CASE("loss parity: every loss of every state, value and gradient", "[losses][parity]") {
  if (!parity::is_here()) return;
  for (const std::string name : {"hood_losses", "ccraft_losses_fold", "ccraft_losses_two"}) {
    const LossFile file = load_losses(name);
    for (std::size_t state = 0; state < file.states.size(); ++state) {
      const LossState s = load_state(file, state);
      const LossOptions options = options_at(file, state);
      const LossMatches matches = matches_at(file, s, state, options);
      for (std::size_t loss = 0; loss < file.losses.size(); ++loss) check_loss(file, s, matches, state, loss, options);
    }
  }
}

TEST_CASE("loss parity: ramps give the weights of the authors' iterations", "[losses][parity]") {
  if (!parity::is_here()) return;
  const Npz hood = parity::open("hood_losses");
  const std::vector<int> iterations = parity::integers(hood, "iter");
  for (std::size_t i = 0; i < iterations.size(); ++i)
    CHECK(weight_at(hood_losses().collision.weight, iterations[i] / 150e3) ==
          Approx(hood.numbers("collision_weight").values[i]));
  const LossFile fold = load_losses("ccraft_losses_fold");
  const std::vector<int> stage = parity::integers(fold.npz, "iter");
  const auto column = [&](const char* loss) {
    return static_cast<std::size_t>(std::ranges::find(fold.losses, loss) - fold.losses.begin());
  };
  const NpyArray<double> weights = fold.npz.numbers("weights");
  for (std::size_t i = 0; i < stage.size(); ++i) {
    const auto theirs = [&](const char* loss) { return weights.values[i * fold.losses.size() + column(loss)]; };
    CHECK(weight_at(testing::contourcraft_losses().collision.weight, stage[i] / 56e3) ==
          Approx(theirs("collision_penalty")));
    CHECK(weight_at(testing::contourcraft_final_losses().contours.weight, (stage[i] - 45e3) / 11e3) ==
          Approx(theirs("icontour")));
  }
}

}  // namespace selvedge::test_loss_parity
