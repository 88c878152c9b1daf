#include <catch2/catch.hpp>

#include <cmath>
#include <set>

#include "learned/steppers/learned_scene.hpp"
#include "pipeline/training/rolling_state.hpp"
#include "tests/pipeline/training/tiny_training.hpp"

// What roll-outs start from: cut garments, tangled ones, materials.
namespace selvedge::test_training_starts {

namespace {

RollMaker contact_maker(GarmentStart start, double noise) {
  RollMaker maker = fake::tiny_maker();
  maker.scenes.clear();
  maker.options.contact.edges = true;
  maker.options.samples.start = start;
  maker.options.samples.noise = noise;
  return maker;
}

RollRequest contact_request(std::uint64_t number) {
  RollRequest request;
  request.number = number;
  request.first_frame = 30;
  request.frames = 2;
  request.cloth_contact = true;
  return request;
}

std::array<int, 3> corners(const Triangles& triangles, Eigen::Index t) {
  return {triangles(t, 0), triangles(t, 1), triangles(t, 2)};
}

bool is_alone(const Surface& surface, int vertex) { return surface.triangles_of(vertex).empty(); }

bool is_in_range(const VertexMaterial& m) {
  constexpr double thickness = 4.7e-4;
  const auto between = [](double value, double low, double high) {
    return value >= low * (1 - 1e-12) && value <= high * (1 + 1e-12);
  };
  return between(m.density, 0.0434, 0.7) && between(m.lame_mu / thickness, 15909, 63636) &&
         between(m.lame_lambda / thickness, 3535.41, 93333.74) && between(m.bending, 6.3708e-8, 1.31397e-3);
}

}  // namespace

TEST_CASE("training starts: what meets other cloth is cut out, and vertices left alone go as they are worn",
          "[training]") {
  constexpr double noise = 0.012;  // with which the T-shirt meets itself
  RollMaker skinned = contact_maker(GarmentStart::skinned, noise), maker = contact_maker(GarmentStart::cut, noise);
  int alone = 0;
  for (std::uint64_t number = 0; number < 3; ++number) {
    INFO(number);
    const Roll plain = make_roll(skinned, contact_request(number)), roll = make_roll(maker, contact_request(number));
    const Surface &whole = plain.scene->scene.surface, &rest = roll.scene->scene.surface;
    IntersectionCache before, after;
    std::set<std::array<int, 3>> crossing;
    for (const auto& [a, b] : intersecting_pairs(whole, plain.start, before)) {
      crossing.insert(corners(whole.triangles, a));
      crossing.insert(corners(whole.triangles, b));
    }
    REQUIRE(crossing.size() >= 2);
    CHECK(roll.usable);
    CHECK(roll.cut >= static_cast<int>(crossing.size()));
    CHECK(rest.triangles.rows() + roll.cut == whole.triangles.rows());
    CHECK(roll.scene->losses.membranes.size() == static_cast<std::size_t>(rest.triangles.rows()));
    CHECK(intersecting_pairs(rest, roll.start, after).empty());
    for (Eigen::Index t = 0; t < rest.triangles.rows(); ++t) CHECK_FALSE(crossing.contains(corners(rest.triangles, t)));
    for (int v = 0; v < rest.vertex_count; ++v) {
      const auto at = static_cast<std::size_t>(v);
      CHECK((roll.scene->graph.types[at] == pinned_vertex) == is_alone(rest, v));
      CHECK((roll.scene->losses.mass[at] == 0) == is_alone(rest, v));
      if (is_alone(rest, v)) CHECK(roll.start.row(v) == roll.cloth[1].row(v).cast<double>());
      alone += is_alone(rest, v);
    }
  }
  CHECK(alone > 0);
  // Without contact of cloth with cloth nothing is cut.
  RollRequest blind = contact_request(0);
  blind.cloth_contact = false;
  CHECK(make_roll(maker, blind).cut == 0);
}

TEST_CASE("training starts: no edge, pair or loss has a vertex that is left alone", "[training]") {
  TrainingOptions options = fake::tiny_training();
  options.contact.edges = true;
  options.samples.start = GarmentStart::cut;
  options.samples.noise = 0.012;
  options.samples.still_share = 0;
  options.pool.states = 1;
  options.pool.frames = {3, 3, 0, 0};
  options.pool.random_length = false;
  options.optimiser.warm_up = 2;
  options.objective.repulsion.weight = {2e6, 2e6, 0, 0};
  const auto trainer = make_trainer(options);
  int alone = 0, pairs = 0;
  for (int step = 0; step < 6; ++step) {
    CHECK(train_step(*trainer).adam.taken);
    const RollingState& state = trainer->pool[0];
    const Surface& cloth = state.roll.scene->scene.surface;
    for (const EdgeSet& set : trainer->samples[0].graph.edge_sets)
      for (std::size_t e = 0; e < set.senders.size(); ++e)
        for (const int node : {set.senders[e], set.receivers[e]})
          if (node < cloth.vertex_count && is_alone(cloth, node)) FAIL_CHECK(set.key << " has vertex " << node);
    for (const BodyPair& pair : state.found.body_pairs) CHECK_FALSE(is_alone(cloth, pair.cloth));
    pairs += static_cast<int>(state.found.cloth_pairs.repulsion.size());
    const SeenPositions seen = seen_positions(state.roll.scene->rest, state.now, trainer->architecture.features);
    Points gradient = Points::Zero(cloth.vertex_count, 3);
    LossSearch search;
    add_losses(inputs_of(state, seen, state.now.x, 1), options.objective, search, &gradient);
    for (int v = 0; v < cloth.vertex_count; ++v) {
      if (!is_alone(cloth, v)) continue;
      ++alone;
      CHECK(gradient.row(v).isZero(0));
    }
  }
  CHECK(alone > 0);
  CHECK(pairs > 0);
}

TEST_CASE("training starts: a start that does not come apart is soon given up", "[training]") {
  RollMaker maker = contact_maker(GarmentStart::untangle, 0);
  Points& worn = maker.world.wear[0].garments[0].skin.rest;
  RandomStream random = stream_of(5, 0);
  for (Eigen::Index i = 0; i < worn.size(); ++i) worn.data()[i] += 0.04 * random.normal();
  const Roll roll = make_roll(maker, contact_request(0));
  CHECK_FALSE(roll.usable);
  CHECK(roll.parting > 0);
  CHECK(roll.parting <= 60);
}

TEST_CASE("training starts: faces of the body that meet others now or next take no part in losses", "[training]") {
  RollMaker maker = contact_maker(GarmentStart::skinned, 0);
  RollRequest request = contact_request(1);
  request.still = false;
  RollingState state;
  begin_roll(make_roll(maker, request), state);
  const Surface& body = state.roll.scene->graph.body;
  std::vector<char> meets(static_cast<std::size_t>(body.triangles.rows()), 0);
  IntersectionCache cache;
  for (const Points* x : {&state.now.body, &state.now.body_target})
    for (const auto& [a, b] : intersecting_pairs(body, *x, cache))
      meets[static_cast<std::size_t>(a)] = meets[static_cast<std::size_t>(b)] = 1;
  REQUIRE(std::ranges::count(meets, 1) > 0);  // the arms, whose soft tissue does not give way
  CHECK(state.body_left_out == meets);
  const FrameMaking making = fake::tiny_making();
  const SeenPositions seen = seen_positions(state.roll.scene->rest, state.now, making.features);
  add_losses(inputs_of(state, seen, state.now.x, 1), making.losses, state.losses, nullptr);
  int matched = 0;
  for (const int face : state.losses.matches.collision_face) {
    if (face < 0) continue;
    ++matched;
    CHECK_FALSE(meets[static_cast<std::size_t>(face)]);
  }
  CHECK(matched > 0);
}

TEST_CASE("training starts: every second roll-out looks for a place with 20 pairs or the most that eight have",
          "[training]") {
  RollMaker maker = contact_maker(GarmentStart::tangled, 0);
  maker.options.samples.clips = {"walk", "arms_up_down", "jumping_jacks"};
  maker.world = make_training_world(maker.options.samples, 1);
  const auto pairs_at = [&](const RollRequest& place) {
    IntersectionCache cache;
    Points x = skinned_frame(maker.world, place.wear, place.body, place.clip, place.first_frame).cloth.cast<double>();
    const auto scene = make_training_scene(maker, place, drawn_materials(maker, place));
    if (place.mirrored) x.col(0) *= -1;
    return static_cast<int>(intersecting_pairs(scene->scene.surface, x, cache).size());
  };
  int many = 0, many_as_drawn = 0, moved = 0;
  constexpr int count = 16;
  for (std::uint64_t number = 0; number < count; ++number) {
    INFO(number);
    RollRequest asked = draw_roll(maker.options, maker.world, number, 0);
    asked.cloth_contact = true;
    int pairs = -1;
    const RollRequest found = tangled_place(maker, asked, pairs);
    const int before = pairs_at(asked);
    CHECK(pairs == pairs_at(found));
    CHECK(pairs >= before);
    if (number % 2 == 1 || before >= 20) CHECK(found == asked);
    many += pairs >= 20;
    many_as_drawn += before >= 20;
    moved += !(found == asked);
  }
  CAPTURE(many, many_as_drawn, moved);
  CHECK(moved >= 3);
  CHECK(many >= many_as_drawn + 3);
}

TEST_CASE("training starts: a share of the roll-outs hangs a sheet with a corner folded through it", "[training]") {
  RollMaker maker = contact_maker(GarmentStart::tangled, 0);
  const auto drawn = [&](double share, std::uint64_t number) {
    maker.options.samples.folded_share = share;
    return draw_roll(maker.options, maker.world, number, 1);
  };
  constexpr int count = 4000;
  int folds = 0;
  for (std::uint64_t number = 0; number < count; ++number) {
    const RollRequest request = drawn(0.25, number), plain = drawn(0, number);
    const bool fold = request.sheet == HungStart::folded;
    folds += fold;
    CHECK((request == plain) == !fold);
    if (fold) CHECK_FALSE((request.with_body || request.still));
  }
  CHECK(folds / double(count) == Approx(0.25).margin(0.03));
  maker.options.pool.no_contact_share = 1;
  for (std::uint64_t number = 0; number < 50; ++number) CHECK(drawn(1, number).sheet == HungStart::none);

  maker.options.pool.no_contact_share = 0;
  std::set<std::array<double, 3>> lowest;  // of the folds: no two are the same
  for (std::uint64_t number = 0; number < 12; ++number) {
    INFO(number);
    const Roll roll = make_roll(maker, drawn(1, number));
    const Scene& scene = roll.scene->scene;
    CHECK(scene.obstacles.empty());
    for (const int pin : scene.pins) CHECK((roll.start.row(pin) - roll.cloth[1].row(pin).cast<double>()).norm() < 1e-6);
    IntersectionCache cache;
    CHECK_FALSE(intersecting_pairs(scene.surface, roll.start, cache).empty());
    RollingState state;
    begin_roll(make_roll(maker, drawn(1, number)), state);
    CHECK(state.now.velocity.isZero());
    CHECK(state.now.x == roll.start);
    const auto p = roll.start.row(roll.start.rows() - 1);
    lowest.insert({p.x(), p.y(), p.z()});
  }
  CHECK(lowest.size() >= 6);
}

TEST_CASE("training starts: roll-outs without a body, without contact of cloth, and long ones have their shares",
          "[training]") {
  TrainingOptions options = read_training(config_folder() / "training" / "contourcraft.yaml");
  options.samples.no_body_share = 0.3;
  constexpr int count = 4000;
  int no_body = 0, no_contact = 0, both = 0, whole = 0, most = 0;
  for (std::uint64_t number = 0; number < count; ++number) {
    const RollRequest request = draw_roll(options, fake::tiny_maker().world, number, 1);
    no_body += !request.with_body;
    no_contact += !request.cloth_contact;
    both += !request.with_body && !request.cloth_contact;
    whole += request.frames > 30;
    most = std::max(most, request.frames);
  }
  CHECK(options.pool.no_contact_share == 0.5);
  CHECK(options.pool.long_share == 0.1);
  CHECK(std::abs(no_body - 0.3 * count) < 0.03 * count);
  CHECK(std::abs(no_contact - 0.5 * count) < 0.03 * count);
  CHECK(std::abs(both - 0.15 * count) < 0.03 * count);  // one does not depend on the other
  CHECK(std::abs(whole - 0.1 * count) < 0.02 * count);
  CHECK(most == 150);
}

TEST_CASE("training starts: materials are drawn for a garment, or change over it from vertex to vertex", "[training]") {
  RollMaker maker = fake::tiny_maker();
  maker.scenes.clear();
  TrainingWear& wear = maker.world.wear[0];
  wear.garments.push_back(wear.garments[0]);  // an outfit of two
  if (!wear.skin.empty()) wear.skin.push_back(wear.skin[0]);
  const auto scene_with = [&](MaterialSampling sampling, std::uint64_t number) {
    maker.options.samples.sample_materials = sampling;
    return make_roll(maker, {.number = number, .first_frame = 30}).scene;
  };
  const auto distinct = [](const TrainingScene& scene, int cloth) {
    const Cloth& part = scene.scene.cloths[static_cast<std::size_t>(cloth)];
    std::set<double> values;
    for (int v = 0; v < part.vertex_count; ++v)
      values.insert(scene.materials[static_cast<std::size_t>(part.first_vertex + v)].lame_mu);
    return values.size();
  };
  const auto none = scene_with(MaterialSampling::none, 1), garment = scene_with(MaterialSampling::garment, 1),
             other = scene_with(MaterialSampling::garment, 2), vertex = scene_with(MaterialSampling::vertex, 1);
  const auto second = static_cast<std::size_t>(none->scene.cloths[1].first_vertex);
  CHECK(none->materials.front() == maker.options.samples.material);
  CHECK(none->materials.back() == maker.options.samples.material);
  for (const int cloth : {0, 1}) {
    CHECK(distinct(*garment, cloth) == 1);
    CHECK(distinct(*vertex, cloth) > static_cast<std::size_t>(vertex->scene.cloths[0].vertex_count / 2));
  }
  CHECK(garment->materials[0].lame_mu != garment->materials[second].lame_mu);
  CHECK(garment->materials[0].lame_mu != other->materials[0].lame_mu);
  for (const auto& scene : {garment, vertex}) {
    const std::size_t vertices = scene->materials.size();
    REQUIRE(vertices == static_cast<std::size_t>(scene->scene.surface.vertex_count));
    CHECK(std::ranges::all_of(scene->materials, is_in_range));
    CHECK(scene->graph.materials == material_inputs(scene->materials));
    CHECK(scene->graph.materials.minCoeff() >= 0);
    CHECK(scene->graph.materials.maxCoeff() <= 1);
    CHECK(scene->graph.mass == scene->losses.mass);
    const RestEdges& mesh = scene->rest.sets[0];
    for (std::size_t e = 0; e < mesh.senders.size(); e += 97)
      CHECK((mesh.materials.row(static_cast<Eigen::Index>(e)) -
             0.5f * (scene->graph.materials.row(mesh.senders[e]) + scene->graph.materials.row(mesh.receivers[e])))
                .cwiseAbs()
                .maxCoeff() < 1e-6f);
    // Triangles and hinges of the losses have the mean of their corners and of their edge's ends.
    for (std::size_t t = 0; t < scene->losses.membranes.size(); t += 53) {
      const MembraneElement& e = scene->losses.membranes[t];
      double mu = 0;
      for (const int v : e.nodes) mu += scene->materials[static_cast<std::size_t>(v)].lame_mu / 3;
      CHECK(scene->losses.materials[static_cast<std::size_t>(e.material)].lame_mu == Approx(mu));
    }
  }
}

TEST_CASE("training starts: graph and losses have a garment's stitches, but those of what is cut out", "[training]") {
  RollMaker maker = fake::tiny_maker();
  maker.scenes.clear();
  Garment& garment = maker.world.wear[0].garments[0];
  RollRequest request;
  request.with_body = false;
  const auto plain = make_training_scene(maker, request, drawn_materials(maker, request));
  CHECK(plain->graph.springs.empty());
  CHECK(plain->losses.springs.empty());
  const auto far = static_cast<int>(garment.skin.rest.rows()) - 1;
  garment.stitches = {{0, far, 0.01}, {1, far - 1, 0.02}};
  const auto stitched = make_training_scene(maker, request, drawn_materials(maker, request));
  REQUIRE(stitched->losses.springs.size() == 2);
  CHECK(stitched->losses.springs[0].stiffness < 500);
  CHECK(stitched->rest.sets[0].senders.size() == plain->rest.sets[0].senders.size() + 4);
  CHECK(stitched->rest.coarse.vertex_level == plain->rest.coarse.vertex_level);
  // All triangles round one end of the first stitch.
  const std::span<const int> round = stitched->scene.surface.triangles_of(far);
  std::vector<int> cut(round.begin(), round.end());
  std::ranges::sort(cut);
  const auto less = cut_scene(maker, request, *stitched, cut);
  REQUIRE(less->graph.springs.size() == 1);
  CHECK(less->graph.springs[0].a == 1);
  CHECK(less->losses.springs.size() == 1);
}

}  // namespace selvedge::test_training_starts
