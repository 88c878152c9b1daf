#include <catch2/catch.hpp>

#include "learned/graph/integration.hpp"
#include "pipeline/weights/import_weights.hpp"
#include "tests/learned/graph_scenes.hpp"
#include "tests/learned/parity_pack.hpp"

namespace selvedge::test_integration {

using namespace selvedge::parity;

namespace {

double apart(const Points& a, const Points& b) { return (a - b).cwiseAbs().maxCoeff(); }

}  // namespace

TEST_CASE("integration: positions and velocities from the authors' network output", "[graph][parity]") {
  if (!is_here()) return;
  for (const std::string& name : all_steps()) {
    INFO(name);
    const Case c = load(name);
    const bool hood = name.starts_with("hood");
    const FeatureTables tables =
        read_published_weights(folder() / (hood ? "hood_w16.pth" : "ccraft_w16.pth")).weights.tables;
    const RestGraph rest = make_rest_graph(c.scene, c.options, c.centres);
    const NextCloth next = integrate(rest, c.state, c.options, tables.output, rows(c.npz, "decoder_output"));
    CHECK(apart(next.x, points(c.npz, "pred_pos")) <= 1e-7);
    CHECK(apart(next.velocity, points(c.npz, "pred_velocity")) <= 1e-7);
    for (const int v : rest.pinned) {
      CHECK(next.x.row(v) == c.state.target.row(v));
      if (hood) CHECK(next.velocity.row(v).isZero(0));
    }
    CHECK(rest.pinned.empty() == (name == "hood_step_nobody_nopin"));
    const SeenPositions seen = seen_positions(rest, c.state, c.options);
    if (c.npz.has("input_pos")) {
      CHECK(apart(seen.mesh, points(c.npz, "input_pos")) == 0);
      CHECK(seen.x == c.state.x);
    }
    if (!c.npz.has("cloth_pos_after_pinning")) continue;
    CHECK(apart(seen.x, points(c.npz, "cloth_pos_after_pinning")) == 0);
    CHECK(apart(seen.previous, points(c.npz, "cloth_prev_pos_after_pinning")) == 0);
  }
}

TEST_CASE("integration: HOOD's first frame is pushed out of the body", "[graph][parity]") {
  if (!is_here()) return;
  const Case c = load("hood_step0");
  for (const auto& [before, after] :
       {std::pair("cloth_pos_before_push", c.state.x), std::pair("cloth_prev_pos_before_push", c.state.previous)}) {
    Points x = points(c.npz, before);
    CHECK(apart(x, after) > 1e-4);
    push_out(c.scene.body, c.state.body, push_out_margin, x);
    CHECK(apart(x, after) <= 1e-7);
  }
}

TEST_CASE("integration: pushing out leaves what is outside, and does nothing without a body", "[graph]") {
  const fake::Mesh body = fake::grid(5, 5);  // its normals point along +y
  const Points x = (Points(3, 3) << 0.04, 0.01, 0.03, 0.04, 0.001, 0.03, 0.04, -0.02, 0.03).finished();
  Points moved = x;
  CHECK(push_out(fake::surface_of(body), body.x, 0.002, moved) == 2);
  CHECK(moved.row(0) == x.row(0));
  CHECK(moved(1, 1) == Approx(0.002));
  CHECK(moved(2, 1) == Approx(0.002));
  CHECK(moved(2, 0) == Approx(0.04));
  moved = x;
  CHECK(push_out(make_surface(0, Triangles(0, 3)), Points(0, 3), 0.002, moved) == 0);
  CHECK(moved == x);
}

}  // namespace selvedge::test_integration
