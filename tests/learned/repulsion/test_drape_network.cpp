#include <catch2/catch.hpp>

#include <array>
#include <cmath>

#include "learned/repulsion/drape_training.hpp"

namespace selvedge::test_drape_network {

namespace {

constexpr double radius = 0.3;

// A sheet of 4 x 4 vertices before a ball, with a frame of its own for each vertex. The ball answers exactly.
struct Ball {
  std::vector<DrapeCase> cases;
  Adjacency ring;

  Ball() {
    std::vector<std::pair<int, int>> pairs;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) {
        if (j < 3) pairs.emplace_back(4 * i + j, 4 * i + j + 1);
        if (i < 3) pairs.emplace_back(4 * i + j, 4 * i + j + 4);
      }
    ring = adjacency_of(16, unique_edges(pairs));
    for (int k = 0; k < 3; ++k) {
      DrapeCase drape;
      drape.inputs = {0.1f * static_cast<float>(k), 1.0f, -0.3f * static_cast<float>(k * k)};
      drape.rest.resize(16, 3);
      drape.truth.resize(16, 3);
      for (int v = 0; v < 16; ++v) {
        const Vec3 p(0.08 * (v % 4 - 1.5), 0.08 * (v / 4 - 1.5), radius - 0.03 + 0.004 * k + 0.001 * v);
        drape.rest.row(v) = p.transpose();
        VertexFrame frame;
        frame.leftCols<3>() = Eigen::AngleAxisd(0.1 * k + 0.01 * v, Vec3(1, 2, 3).normalized()).toRotationMatrix();
        frame.col(3) = Vec3(0, 0.01 * k, 0);
        drape.frames.push_back(frame);
        drape.truth.row(v) = (1.01 * radius * (frame.leftCols<3>() * p + frame.col(3)).normalized()).transpose();
      }
      cases.push_back(drape);
    }
  }
};

void ask_ball(const Points& at, std::vector<SignedDistance>& found) {
  found.assign(static_cast<std::size_t>(at.rows()), {});
  for (int i = 0; i < at.rows(); ++i) {
    const Vec3 p = row(at, i);
    found[static_cast<std::size_t>(i)].value = p.norm() - radius;
    found[static_cast<std::size_t>(i)].gradient = p.normalized();
    found[static_cast<std::size_t>(i)].closest = radius * p.normalized();
  }
}

std::vector<const DrapeCase*> pointers(const Ball& ball) {
  std::vector<const DrapeCase*> all;
  for (const DrapeCase& drape : ball.cases) all.push_back(&drape);
  return all;
}

DrapeModel model_of(const Ball& ball, bool learned) {
  DrapeModel model{make_drape_network({3, 12, 0.5}, pointers(ball), 3), {}};
  if (!learned) return model;
  ScaleShape shape{3, 16, 64};
  shape.latent = 8;
  shape.per_vertex = 4;
  model.scale = make_scale_network(shape, 5);
  return model;
}

std::vector<DrapeLesson> lessons_of(const Ball& ball) {
  std::vector<DrapeLesson> lessons;
  for (const DrapeCase& drape : ball.cases) lessons.push_back({&drape, ask_ball, ask_ball});
  return lessons;
}

// Largest difference of the gradient from a central one over some parameters, relative to the largest component.
template <class Loss>
double difference(PlainNetwork& network, const std::vector<float>& gradient, const Loss& loss) {
  std::vector<float> parameters = parameters_of(network);
  double worst = 0, largest = 0;
  for (const float g : gradient) largest = std::max(largest, std::abs(static_cast<double>(g)));
  for (std::size_t k = 0; k < parameters.size(); k += std::max<std::size_t>(1, parameters.size() / 23)) {
    const float kept = parameters[k], step = 2e-3f;
    parameters[k] = kept + step;
    set_parameters(parameters, network);
    const double above = loss();
    parameters[k] = kept - step;
    set_parameters(parameters, network);
    const double below = loss();
    parameters[k] = kept;
    set_parameters(parameters, network);
    worst = std::max(worst, std::abs((above - below) / (2 * static_cast<double>(step)) - gradient[k]));
  }
  return worst / largest;
}

}  // namespace

TEST_CASE("drape network: the mean drape is where a network of zeros puts the cloth", "[drapes]") {
  const Ball ball;
  const DrapeCase* const one = &ball.cases[1];
  DrapeNetwork network = make_drape_network({3, 12}, {&one, 1}, 1);
  set_parameters(std::vector<float>(static_cast<std::size_t>(parameter_count(network.plain)), 0), network.plain);
  CHECK((drape_positions(network, *one) - one->truth).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("drape network: a linear part goes through the drapes it was fitted to, and not through those of one input",
          "[drapes]") {
  const Ball ball;
  const auto worst = [&](const DrapeNetwork& network) {
    double most = 0;
    for (const DrapeCase& drape : ball.cases)
      most = std::max(most, (drape_positions(network, drape) - drape.truth).cwiseAbs().maxCoeff());
    return most;
  };
  DrapeNetwork network = make_drape_network({3, 12, 0, {}}, pointers(ball), 1);
  const double without = worst(network);
  fit_linear_part(pointers(ball), 1e-9, {}, network);
  CHECK(worst(network) < 1e-6);
  fit_linear_part(pointers(ball), 1e9, {}, network);
  CHECK(worst(network) == Approx(without).epsilon(1e-3));
  const std::array<double, 3> trust{1, 0, 0};
  fit_linear_part(pointers(ball), 1e-9, trust, network);
  CHECK(network.linear.rightCols(2).isZero(0));
  CHECK(!network.linear.col(0).isZero(0));
  DrapeNetwork blind = make_drape_network({3, 12, 0, {true, true, true}}, pointers(ball), 1);
  fit_linear_part(pointers(ball), 1e-9, {}, blind);
  CHECK(blind.linear.isZero(0));
  CHECK(worst(blind) == Approx(without).epsilon(1e-9));
}

TEST_CASE("drape network: gradients of the losses are their derivatives, without and behind the layer", "[drapes]") {
  const Ball ball;
  const std::vector<DrapeLesson> lessons = lessons_of(ball);
  DrapeRecipe recipe;
  recipe.loss = {1.5, 0.5, 0.1, LayerGradient::full};
  SECTION("without") {
    DrapeModel model = model_of(ball, false);
    const DrapeGradients made = drape_gradients(model, lessons, ball.ring, recipe);
    CHECK(made.collision > 0);
    CHECK(difference(model.drape.plain, made.parts[0],
                     [&] { return drape_gradients(model, lessons, ball.ring, recipe).total; }) < 5e-3);
  }
  SECTION("behind the layer: the scales") {
    recipe.layer = true;
    DrapeModel model = model_of(ball, true);
    const DrapeGradients made = drape_gradients(model, lessons, ball.ring, recipe);
    REQUIRE(made.pushed >= 3);
    const auto loss = [&] { return drape_gradients(model, lessons, ball.ring, recipe).total; };
    CHECK(difference(model.scale.g, made.parts[3], loss) < 2e-2);
    CHECK(difference(model.scale.k, made.parts[2], loss) < 2e-2);
    CHECK(difference(model.scale.h, made.parts[1], loss) < 2e-2);
  }
  SECTION("behind the layer: scales by neighbours, and the network before them") {
    recipe.layer = true;
    DrapeModel model = model_of(ball, false);
    NeighbourShape shape;
    shape.edge_unit = 0.08;
    model.neighbours = make_neighbour_scale(shape, 5);
    model.neighbours.end.layers.back().weight *= 60;
    const DrapeGradients made = drape_gradients(model, lessons, ball.ring, recipe);
    REQUIRE(made.pushed >= 3);
    const auto loss = [&] { return drape_gradients(model, lessons, ball.ring, recipe).total; };
    const std::vector<DrapePart> parts = parts_of(model);
    REQUIRE(parts.size() == 4);
    for (std::size_t k = 1; k < parts.size(); ++k) CHECK(difference(*parts[k].network, made.parts[k], loss) < 2e-2);
  }
}

TEST_CASE("drape network: steps of Adam make the loss smaller, and a bad gradient changes nothing", "[drapes]") {
  const Ball ball;
  const std::vector<DrapeLesson> lessons = lessons_of(ball);
  DrapeRecipe recipe;
  recipe.layer = true;
  DrapeModel model = model_of(ball, true);
  DrapeAdam adam;
  const double before = drape_gradients(model, lessons, ball.ring, recipe).total;
  for (int k = 0; k < 60; ++k)
    REQUIRE(take_step(adam, drape_gradients(model, lessons, ball.ring, recipe), 2e-3, model));
  CHECK(drape_gradients(model, lessons, ball.ring, recipe).total < 0.5 * before);
  DrapeGradients bad = drape_gradients(model, lessons, ball.ring, recipe);
  REQUIRE(!bad.parts[1].empty());
  bad.parts[1][0] = std::nanf("");
  const std::vector<float> kept = parameters_of(model.drape.plain);
  CHECK(!take_step(adam, bad, 2e-3, model));
  CHECK(parameters_of(model.drape.plain) == kept);
}

}  // namespace selvedge::test_drape_network
