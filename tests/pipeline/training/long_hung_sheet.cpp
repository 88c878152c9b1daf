#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include "pipeline/training/training_watch.hpp"
#include "tests/pipeline/training/tiny_training.hpp"

// Whether the weights of `senc` that ship feel a force, whichever way the sheet faces.

namespace selvedge::test_hung_sheet {

namespace {

constexpr int frames = 120;  // of which the second half is looked at
constexpr double degree = std::numbers::pi / 180;

TrainingOptions shipped_senc() {
  TrainingOptions options = fake::tiny_training();
  options.architecture = "small_senc";
  options.width = options.message_steps = 0;
  options.pool.passes = 2;
  options.samples.edge = 0.035;
  options.samples.noise = 0;
  options.weights = (config_folder() / "weights" / "senc.h5").string();
  return options;
}

// Mean angle of the sheet against the vertical [degrees]: along the force, and across it.
std::array<double, 2> angles_under(Trainer& trainer, double heading, double acceleration) {
  RollRequest request;
  request.sheet = HungStart::flat;
  request.with_body = false;
  request.frames = frames + 1;  // the first settles
  request.yaw = heading;
  const Vec3 along(std::sin(heading), 0, std::cos(heading)), across(along.z(), 0, -along.x());
  request.force = acceleration * along;
  RollingState state;
  trainer.queue->locked([&] { begin_roll(make_roll(*trainer.maker, request), state); });
  const FrameMaking making = frame_making(trainer);
  const auto columns = static_cast<Eigen::Index>(state.roll.scene->rest.pinned.size());
  std::array<double, 2> sum{};
  int count = 0;
  while (!state.over) {
    NextCloth next;
    REQUIRE(predict(trainer, making, state, next));
    if (state.pass + 1 == making.passes && state.frame > frames / 2) {
      const Vec3 down = (next.x.bottomRows(columns).colwise().mean() - next.x.topRows(columns).colwise().mean());
      sum[0] += std::atan2(down.dot(along), -down.y()) / degree;
      sum[1] += std::atan2(down.dot(across), -down.y()) / degree;
      ++count;
    }
    take_pass(making, next, HUGE_VAL, state);
  }
  return {sum[0] / count, sum[1] / count};
}

}  // namespace

TEST_CASE("weights of SENC: a hung sheet takes the angle at which forces balance", "[training][.long]") {
  const auto trainer = make_trainer(shipped_senc());
  double squares = 0;
  int count = 0;
  for (const double acceleration : {0., 2., 5., 8.})
    for (int quarter = 0; quarter < 4; ++quarter) {
      const auto [along, across] = angles_under(*trainer, quarter * 90 * degree, acceleration);
      const double wanted = std::atan(acceleration / 9.81) / degree;
      WARN(acceleration << " m/s2, turned by " << 90 * quarter << ": " << along << " of " << wanted << ", across "
                        << across);
      CHECK(along == Approx(wanted).epsilon(0.2).margin(2));
      CHECK(across == Approx(0).margin(2));
      squares += (along - wanted) * (along - wanted) + across * across;
      ++count;
    }
  WARN("RMS error " << std::sqrt(squares / count) << " degrees");
}

}  // namespace selvedge::test_hung_sheet
