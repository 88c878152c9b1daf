// A sheet falls on a plate: a scene from arrays, stepped for two seconds.
#include <cstdio>
#include <selvedge/physics/frame/make_frame.hpp>
#include <selvedge/physics/scene/make_scene.hpp>
#include <selvedge/physics/steppers/decorated_stepper.hpp>

using namespace selvedge;

int main() {
  Points sheet(9, 3), plate(4, 3);  // n x 3 [m], Y up
  Triangles quads(8, 3), halves(2, 3);
  for (int i = 0; i < 9; ++i) sheet.row(i) << 0.1 * (i % 3), 0.2 + 0.01 * (i % 2), 0.1 * (i / 3);
  for (int q = 0; q < 4; ++q) {
    const int a = q % 2 + 3 * (q / 2);
    quads.row(2 * q) << a, a + 3, a + 1;
    quads.row(2 * q + 1) << a + 1, a + 3, a + 4;
  }
  plate << -1, 0, -1, -1, 0, 1, 1, 0, -1, 1, 0, 1;
  halves << 0, 1, 2, 2, 1, 3;
  Scene scene;
  add_cloth(scene, sheet, quads);
  add_obstacle(scene, 4, halves);
  State state = first_state(scene, sheet, {plate}), next;
  const auto stepper = make_recovering_conventional_stepper(scene);
  FrameAudits audits(scene);
  for (int frame = 0; frame < 60; ++frame) {
    const StepReport report = make_frame(*stepper, audits, state, at_rest(scene, state), 1.0 / 30, next);
    if (report.status == StepStatus::accepted) state = next;
  }
  std::printf("lowest vertex %.4f m, clean: %s\n", state.x.col(1).minCoeff(), state.clean ? "yes" : "no");
  return state.clean && state.x.col(1).minCoeff() > 0 ? 0 : 1;
}
