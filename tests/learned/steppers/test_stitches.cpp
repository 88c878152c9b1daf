#include <catch2/catch.hpp>

#include <array>
#include <cmath>

#include "learned/losses/cloth_losses.hpp"
#include "learned/losses/force_input.hpp"
#include "learned/network/weights_hdf5.hpp"
#include "tests/frame.hpp"
#include "tests/learned/learned_scenes.hpp"
#include "tests/source_root.hpp"

namespace selvedge::test_stitches {

namespace {

// A sheet of 0.4 m that hangs from its upper edge, and a patch 4 mm before it, stitched on by three sides like a
// pocket.
struct Pocketed {
  fake::LearnedCase run;
  int sheet = 0, patch = 0;  // vertices
};

fake::Mesh hanging(int n, double edge) {
  fake::Mesh mesh = fake::grid(n, n, edge);
  const Points flat = mesh.x;
  mesh.x.col(1) = flat.col(2);
  mesh.x.col(2) = -flat.col(1);
  return mesh;
}

Pocketed pocketed(int frames) {
  constexpr int side = 5;
  const fake::Mesh sheet = hanging(12, 0.035);
  fake::Mesh patch = hanging(side, 0.03);
  patch.x.rowwise() += Eigen::RowVector3d(0.12, 0.1, 0.004);
  Pocketed made{fake::learned_case(sheet, {}, {0, 0, 0}, 0), static_cast<int>(sheet.x.rows()),
                static_cast<int>(patch.x.rows())};
  Scene& scene = made.run.scene;
  add_cloth(scene, patch.x, patch.triangles, scene.cloths[0].material, "patch");
  scene.pins.clear();
  for (int v = 0; v < made.sheet; ++v)
    if (sheet.x(v, 1) > sheet.x.col(1).maxCoeff() - 1e-6) scene.pins.push_back(v);
  for (int k = 0; k < made.patch; ++k) {
    if (k / side != 0 && k % side != 0 && k % side != side - 1) continue;
    Eigen::Index nearest = 0;
    const double length = (sheet.x.rowwise() - patch.x.row(k)).rowwise().norm().minCoeff(&nearest);
    scene.springs.push_back({made.sheet + k, static_cast<int>(nearest), length});
  }
  made.run.state.x = scene.rest;
  made.run.state.v = Points::Zero(scene.rest.rows(), 3);
  for (int k = 1; k <= frames; ++k) {
    Drive drive;
    drive.acceleration = {0, -9.81, 0};
    drive.pins = sheet.x(scene.pins, Eigen::all).rowwise() +
                 Eigen::RowVector3d(0.1 * std::sin(0.2 * k), 0, 0.1 * std::sin(0.15 * k));
    made.run.drives.push_back(drive);
  }
  return made;
}

// The largest difference of a stitch from its length, over all frames [m].
double largest_gap(const fake::LearnedCase& run, const Scene& seen, const std::string& weights) {
  const WeightFile file = read_weight_file(source_root() / "configs" / "weights" / weights);
  const auto stepper = make_learned_stepper(seen, file.architecture, file.weights);
  State state = run.state;
  double gap = 0;
  for (const Drive& drive : run.drives) {
    State to;
    REQUIRE(testing::frame(run.scene, *stepper, state, drive, 1.0 / 30, to).status == StepStatus::accepted);
    state = std::move(to);
    for (const Spring& spring : run.scene.springs)
      gap = std::max(gap, std::abs((row(state.x, spring.a) - row(state.x, spring.b)).norm() - spring.rest_length));
  }
  return gap;
}

fake::World with_springs(const std::vector<Spring>& springs) {
  fake::Mesh two = fake::grid(4, 4);
  add(two, fake::grid(3, 3), {0.02, 0.1, 0.01});
  fake::World made = fake::world(two);
  made.scene.springs = springs;
  return made;
}

using Edge = std::array<int, 2>;
std::vector<Edge> mesh_edges(const RestGraph& rest) {
  std::vector<Edge> edges;
  for (std::size_t e = 0; e < rest.sets[0].senders.size(); ++e)
    edges.push_back({rest.sets[0].senders[e], rest.sets[0].receivers[e]});
  return edges;
}

}  // namespace

TEST_CASE("stitches: networks see each as an edge of the mesh, as long as it says", "[learned][graph]") {
  for (const char* preset : {"hood", "contourcraft", "small"}) {
    INFO(preset);
    const FeatureOptions features = architecture_preset(preset).features;
    const RestGraph without = make_rest_graph(with_springs({}).scene, features),
                    with = make_rest_graph(with_springs({{2, 20, 0.003}, {20, 2, 0.003}}).scene, features);
    const std::vector<Edge> before = mesh_edges(without), after = mesh_edges(with);
    REQUIRE(after.size() == before.size() + 2);  // once, both ways
    const RestEdges &was = without.sets[0], &is = with.sets[0];
    int found = 0;
    for (std::size_t e = 0, k = 0; e < after.size(); ++e) {
      const auto at = static_cast<Eigen::Index>(e);
      const Eigen::Index last = is.rest.cols() - 1;
      if (after[e] == Edge{2, 20} || after[e] == Edge{20, 2}) {
        ++found;
        CHECK(is.rest(at, last) == 0.003f);
        if (last > 0) CHECK(is.rest.row(at).head(3).norm() == Approx(0.003));
        continue;
      }
      // All others are as before, in their order and to the bit.
      CHECK(after[e] == before[k]);
      CHECK(is.rest.row(at) == was.rest.row(static_cast<Eigen::Index>(k)));
      ++k;
    }
    CHECK(found == 2);
    CHECK(with.vertex_levels == without.vertex_levels);
    // Where a triangle's edge joins the two already, the edge stays as it is.
    const Edge own = before[0];
    const RestGraph same = make_rest_graph(with_springs({{own[0], own[1], 0.5}}).scene, features);
    CHECK(mesh_edges(same) == before);
    CHECK(same.sets[0].rest == was.rest);
  }
  CHECK_THROWS(make_rest_graph(with_springs({{2, 99, 0.003}}).scene, hood_features()));
}

TEST_CASE("stitches: the force that networks are shown closes a gap and does not hide others", "[learned]") {
  const Pocketed pocket = pocketed(0);
  const Scene& scene = pocket.run.scene;
  LossGarment garment = loss_garment(scene);
  const std::vector<double> alone = jacobi_diagonal(garment, 1.0 / 30);
  set_springs(scene.springs, garment);
  REQUIRE(garment.springs.size() == scene.springs.size());
  const Spring& spring = garment.springs[1];
  CHECK(spring.stiffness < 500);  // of 10,000
  CHECK(jacobi_diagonal(garment, 1.0 / 30)[static_cast<std::size_t>(spring.a)] ==
        Approx(alone[static_cast<std::size_t>(spring.a)] + 2 * spring.stiffness));
  Points x = scene.rest, slope = Points::Zero(x.rows(), 3);
  x.bottomRows(pocket.patch).col(2).array() += 0.01;
  const double value = spring_loss(garment, x, &slope);
  CHECK(slope(spring.a, 2) > 0);  // towards the sheet is down the slope
  CHECK((slope.row(spring.a) + slope.row(spring.b)).norm() <= slope.row(spring.b).norm());
  constexpr double h = 1e-6;
  x(spring.a, 2) += h;
  CHECK(spring_loss(garment, x, nullptr) - value == Approx(h * slope(spring.a, 2)).epsilon(1e-3));
}

TEST_CASE("stitches: a patch stays on a sheet that moves, with networks that ship", "[learned]") {
  const Pocketed pocket = pocketed(30);
  Scene unstitched = pocket.run.scene;
  unstitched.springs.clear();
  for (const char* weights : {"hood.h5", "contourcraft_shown.h5"}) {
    INFO(weights);
    CHECK(largest_gap(pocket.run, pocket.run.scene, weights) < 0.012);
    CHECK(largest_gap(pocket.run, unstitched, weights) > 0.2);
  }
}

}  // namespace selvedge::test_stitches
