#include <catch2/catch.hpp>

#include "collision/audit/audit.hpp"
#include "pipeline/bodies/body_hdf5.hpp"
#include "pipeline/bodies/body_makehuman.hpp"
#include "pipeline/bodies/mannequin.hpp"
#include "pipeline/scene/setup.hpp"
#include "tests/pipeline/fake_makehuman.hpp"
#include "tests/pipeline/fake_skeleton.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/refusal.hpp"

namespace selvedge::test_setup_body {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

Setup with_body(const Folder& folder, const std::string& body, const std::string& more = "") {
  return read_setup(fake::write(folder, "scene.yaml",
                                "cloths:\n  - {rectangle: {size: [0.3, 0.3], resolution: 3}, translate: [0, 3, 0]}\n"
                                "obstacles:\n  - name: person\n    body: " +
                                    body + "\n" + more));
}

Points body_at(const Setup& setup, double time) { return setup.drive_at(time).obstacles.at(0); }

}  // namespace

TEST_CASE("A body without a clip stands in the zero pose, with its shape", "[setup_body]") {
  const Folder folder("body_still");
  const Setup setup = with_body(folder, "{model: mannequin, shape: [1, 0.5]}");
  const BodyModel body = make_mannequin();
  const Obstacle& person = setup.scene.obstacles.at(0);
  CHECK(person.name == "person");
  CHECK_FALSE(person.moving);
  CHECK(person.surface.triangles == body.skin.triangles);
  CHECK(is_closed(person.surface));
  const Points expected = shaped(body.skin, Eigen::Vector2d(1, 0.5));
  CHECK((setup.initial.obstacles.at(0) - expected).cwiseAbs().maxCoeff() < 1e-12);
  CHECK(body_at(setup, 0.7) == body_at(setup, 0));
  const Setup again = read_setup(fake::write(folder, "again.yaml", setup.config));
  CHECK(again.initial.obstacles.at(0) == setup.initial.obstacles.at(0));
}

TEST_CASE("A clip moves the body over the ground, blended in from a start pose, and placed", "[setup_body]") {
  const Folder folder("body_walks");
  const Setup walk = with_body(folder, "{clip: walk}");
  CHECK(walk.scene.obstacles.at(0).moving);
  for (const double time : {0.0, 1.3, 2.9}) {
    const Points x = body_at(walk, time);
    CHECK(x.allFinite());
    CHECK(std::abs(x.col(1).minCoeff()) < 0.02);  // the soles
    CHECK(x.col(1).maxCoeff() == Approx(1.72).margin(0.06));
  }
  CHECK((body_at(walk, 2) - body_at(walk, 1)).colwise().mean().norm() > 0.3);

  const Setup soft = with_body(folder, "{clip: walk, blend_in: 1, start_pose: zero}");
  const Points start = body_at(soft, 0), later = body_at(soft, 2.3);
  CHECK(start.col(0).maxCoeff() - start.col(0).minCoeff() == Approx(1.78).margin(0.05));  // arms out
  CHECK((later - body_at(walk, 1.3)).cwiseAbs().maxCoeff() < 1e-9);

  const Setup aside = with_body(folder, "{clip: walk}", "    translate: [2, 0, 1]\n");
  CHECK((body_at(aside, 1) - body_at(walk, 1)).rowwise().norm().minCoeff() == Approx(std::sqrt(5.0)));
}

TEST_CASE("A clip that turns round goes backward, forward again, and then stands still", "[setup_body]") {
  const Folder folder("body_turns");
  const Setup once = with_body(folder, "{clip: walk, first_frame: 100, room: 0}"),
              turned = with_body(folder, "{clip: walk, first_frame: 100, turns: 2, room: 0}");
  const auto frame = [](const Setup& setup, int k) { return body_at(setup, k / 30.0); };
  constexpr int last = 79;  // the clip has 180 frames
  for (const int k : {0, 7, 20, 40, last}) {
    INFO(k);
    const Points there = frame(once, k);
    for (const int same : {k, 2 * last - k, 2 * last + k})
      CHECK((frame(turned, same) - there).cwiseAbs().maxCoeff() < 1e-12);
  }
  CHECK((frame(turned, 3 * last + 5) - frame(once, last)).cwiseAbs().maxCoeff() < 1e-12);
  CHECK((frame(once, 40) - frame(once, 0)).rowwise().norm().mean() > 0.05);
  CHECK((frame(once, 20) - frame(once, 40)).rowwise().norm().mean() > 0.05);
  CHECK_THROWS_WITH(with_body(folder, "{clip: walk, turns: -1}"), Contains("turns"));
}

TEST_CASE("A body with a clip gives way where it would pass through itself, unless no room is asked for",
          "[setup_body]") {
  const Folder folder("body_soft_tissue");
  const Setup soft = with_body(folder, "{clip: walk}"), skinned = with_body(folder, "{clip: walk, room: 0}");
  const Surface& surface = soft.scene.obstacles.at(0).surface;
  const auto crossings = [&](const Points& x) { return audit(surface, x, {}).intersecting_pairs(); };
  for (const double time : {0.0, 1.1, 3.2}) {
    CHECK(crossings(body_at(skinned, time)) > 0);  // under the arms
    CHECK(crossings(body_at(soft, time)) == 0);
    CHECK((body_at(soft, time) - body_at(skinned, time)).rowwise().norm().maxCoeff() < 0.045);
  }
}

TEST_CASE("Parts that have come together keep their room from frame to frame", "[setup_body]") {
  const Folder folder("body_room");
  const double room = 0.01;
  const Setup dance = with_body(folder, "{clip: dance_disco, room: 1 cm}");
  const Points rest = make_mannequin().skin.rest;
  // Thighs that nearly close; frame 167 pinched them where a shoulder was in the way of opening.
  for (int frame = 164; frame <= 170; ++frame) {
    CAPTURE(frame);
    const Points x = body_at(dance, frame / 30.0);
    double least = 1;
    for (int v = 0; v < x.rows(); ++v)
      for (int w = 0; w < v; ++w)
        if ((x.row(v) - x.row(w)).cwiseAbs().maxCoeff() < room && (rest.row(v) - rest.row(w)).norm() > 0.25)
          least = std::min(least, (x.row(v) - x.row(w)).norm());
    CHECK(least > 0.85 * room);
  }
}

TEST_CASE("A body walks as a BVH file has it", "[setup_body]") {
  const auto file = fake::open_data() / "makehuman" / "walk1.bvh";
  if (!std::filesystem::exists(file)) {
    WARN("skipped: no " << file);
    return;
  }
  const Folder folder("body_bvh");
  const Setup walk = with_body(folder, "{clip: '" + file.string() + "'}");
  const Points x = body_at(walk, 1);
  CHECK(x.col(1).minCoeff() > -0.05);
  CHECK(x.col(1).maxCoeff() == Approx(1.7).margin(0.12));
}

TEST_CASE("A body that was modelled with its arms down starts as it was and moves as one with its arms out",
          "[setup_body]") {
  const Folder folder("body_lowered");
  const auto write = [&](const std::string& name, const Points& joints) {
    fake::MakeHuman rig(joints);
    rig.off.setZero();
    const auto [mesh, skeleton, weights] = rig.write(folder);
    const BodyModel body = read_makehuman(mesh, skeleton, weights, rig.unit);
    write_body(folder.path / name, body);
    return body;
  };
  write("out.h5", fake::skeleton());
  const BodyModel lowered = write("lowered.h5", fake::lowered(fake::skeleton()));
  const auto joint = [](const Points& x, int j) { return Vec3(x.middleRows(6 * j, 6).colwise().mean().transpose()); };

  // Cloth that was fitted to the body as it is starts clean.
  const Setup soft = with_body(folder, "{model: lowered.h5, clip: walk, blend_in: 1, start_pose: zero}");
  Points start = body_at(soft, 0);
  start.rowwise() += lowered.skin.rest.row(40) - start.row(40);
  CHECK((start - lowered.skin.rest).cwiseAbs().maxCoeff() < 1e-9);

  for (const std::string body :
       {"clip: arms_up_down", "clip: walk", "clip: walk, blend_in: 1, start_pose: arms_down"}) {
    INFO(body);
    const Setup a = with_body(folder, "{model: lowered.h5, " + body + "}");
    const Setup b = with_body(folder, "{model: out.h5, " + body + "}");
    for (const double time : {0.0, 0.5, 1.5, 2.5}) {
      const Points x = body_at(a, time), y = body_at(b, time);
      for (const auto& [from, to] : std::vector<std::pair<int, int>>{{16, 18}, {18, 20}, {17, 19}, {19, 21}}) {
        const Vec3 ours = (joint(x, to) - joint(x, from)).normalized();
        CHECK((ours - (joint(y, to) - joint(y, from)).normalized()).norm() <
              0.15);  // its own arms are not quite along X
      }
      CHECK(std::abs(x.col(1).minCoeff()) < 0.02);
    }
  }
  // Arms hang, so that it is not chance.
  const Points hanging = body_at(with_body(folder, "{model: lowered.h5, clip: walk}"), 0);
  CHECK((joint(hanging, 18) - joint(hanging, 16)).normalized().y() < -0.8);

  BodyModel lacking = lowered;
  lacking.joints[4] = "knee";
  write_body(folder.path / "lacking.h5", lacking);
  CHECK_THROWS_WITH(with_body(folder, "{model: lacking.h5, clip: walk}"),
                    Contains("scene.yaml:5") && Contains("left_knee") && Contains("lacks"));
  CHECK_NOTHROW(with_body(folder, "{model: lacking.h5}"));
}

TEST_CASE("The drive says shape, pose and joints of every body, whatever it comes from", "[setup_body]") {
  const Folder folder("body_drive");
  BodyModel model = make_mannequin();
  write_body(folder.path / "own.h5", model);
  for (const std::string body : {"clip: walk, shape: [0.5, -1]", "shape: [1]", "model: own.h5, clip: squat"}) {
    INFO(body);
    const Setup setup = with_body(folder, "{room: 0, " + body + "}",
                                  "    translate: [0.5, 0, 1]\n    motion: {keyframes: [{time: 0}, {time: 1, rotate: "
                                  "[0, 90, 0]}]}\n  - {name: floor, plane: {size: [4, 4], edge: 1}}\n");
    for (const double time : {0.0, 0.8}) {
      const Drive drive = setup.drive_at(time);
      REQUIRE(drive.bodies.size() == 2);
      CHECK_FALSE(drive.bodies[1].is_body());
      const BodyFrame& frame = drive.bodies[0];
      REQUIRE(frame.joints.rows() == static_cast<Eigen::Index>(model.joints.size()));
      CHECK((frame.shape.size() > 0) == (body.find("shape") != std::string::npos));
      const BodyPose pose{frame.rotations, frame.translation};
      const Points skin = posed(model, frame.shape, pose);
      const Points joints = posed_joints(model, joint_positions(model, frame.shape), pose);
      // Placing and motion keep distances: joints lie in the scene's body as they lie in the posed one.
      for (const Eigen::Index joint : {0, 7, 20})
        for (const Eigen::Index vertex : {0, 100, 900})
          CHECK((frame.joints.row(joint) - drive.obstacles[0].row(vertex)).norm() ==
                Approx((joints.row(joint) - skin.row(vertex)).norm()).epsilon(1e-6));
    }
  }
  const Setup without =
      read_setup(fake::write(folder, "none.yaml",
                             "cloths: [{rectangle: {size: [0.3, 0.3], resolution: 3}}]\n"
                             "obstacles: [{sphere: {radius: 0.1, edge: 0.05}, translate: [0, -1, 0]}]\n"));
  CHECK(without.drive_at(0.5).bodies.empty());
}

TEST_CASE("The drive says of a body that it does not cross itself only where that is so", "[setup_body]") {
  const Folder folder("body_apart");
  int said = 0, crossed = 0;
  for (const std::string clip : {"walk", "hands_through_torso"}) {
    const Setup setup = with_body(folder, "{room: 0.01, clip: " + clip + "}",
                                  "    translate: [0.5, 0, 1]\n    motion: {keyframes: [{time: 0}, {time: 1, rotate: "
                                  "[0, 90, 0]}]}\n");
    for (double time = 0; time < 1.5; time += 0.25) {
      INFO(clip << " at " << time);
      const Drive drive = setup.drive_at(time);
      const bool crosses = audit(setup.scene.obstacles[0].surface, drive.obstacles[0], {}).intersecting_pairs() > 0;
      CHECK_FALSE((drive.bodies[0].apart && crosses));
      said += drive.bodies[0].apart;
      crossed += crosses;
    }
  }
  CHECK(said >= 6);
  CHECK(crossed > 0);
}

TEST_CASE("A body of a hundred times its size is named, with the scale that mends it", "[setup_body]") {
  const Folder folder("body_large");
  BodyModel body = make_mannequin();
  body.skin.rest *= 100;
  write_body(folder.path / "large.h5", body);
  CHECK_THAT(fake::lines(with_body(folder, "{model: large.h5}").warnings),
             Contains("body `person` spans") && Contains("scale: 0.01"));
  CHECK_THAT(fake::lines(with_body(folder, "{model: large.h5}", "    scale: 0.01\n").warnings), !Contains("spans"));
  CHECK_THAT(fake::lines(with_body(folder, "{model: mannequin}").warnings), !Contains("spans"));
  CHECK_THAT(fake::lines(with_body(folder, "{model: mannequin, shape: [1e4]}").warnings),
             Contains("body `person` spans"));
  CHECK_THAT(testing::refusal([&] { with_body(folder, "{model: mannequin, shape: [1e12]}"); }),
             Contains("body.shape") && Contains("makes the body absurdly large"));
}

TEST_CASE("What is wrong with a body is named by file, line and cure", "[setup_body]") {
  const Folder folder("body_faulty");
  CHECK_THROWS_WITH(with_body(folder, "{clip: wlak}"),
                    Contains("scene.yaml:5") && Contains("unknown clip") && Contains("did you mean `walk`"));
  CHECK_THROWS_WITH(with_body(folder, "{shape: [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1]}"), Contains("at most 10"));
  CHECK_THROWS_WITH(with_body(folder, "{shape: [tall]}"), Contains("list of them"));
  CHECK_THROWS_WITH(with_body(folder, "{model: person.npz}"), Contains("missing file"));
  fake::write(folder, "person.fbx", "");
  CHECK_THROWS_WITH(with_body(folder, "{model: person.fbx}"), Contains("export it as .glb"));
  fake::write(folder, "person.h5", "no hdf5");
  CHECK_THROWS_WITH(with_body(folder, "{model: person.h5}"), Contains("person.h5"));
}

}  // namespace selvedge::test_setup_body
