#include "pipeline/drapes/drape_lessons.hpp"

#include "collision/geometry/error.hpp"

namespace selvedge {
namespace {

// Maps the posed body into each joint's own frame in the zero pose.
QueryMap query_of_bones(const JointTransforms& transforms, const Points& joints) {
  std::vector<Eigen::Matrix<double, 3, 4>> frames;
  for (std::size_t j = 0; j < transforms.size(); ++j) {
    Eigen::Matrix<double, 3, 4> back;
    back.leftCols<3>() = transforms[j].leftCols<3>().transpose();
    back.col(3) = -back.leftCols<3>() * transforms[j].col(3) - row(joints, static_cast<int>(j));
    frames.push_back(back);
  }
  return bone_query(frames);
}

std::unique_ptr<DrapeBody> make_drape_body(const DrapeWorld& world, const DrapePath& path, std::size_t index,
                                           bool bones) {
  auto made = std::make_unique<DrapeBody>();
  made->sample = drape_sample(world, path, index);
  made->field = std::make_unique<DistanceField>(world.body_surface);
  made->field->move_to(made->sample.body);
  made->query =
      bones ? query_of_bones(made->sample.transforms, joint_positions(world.body, path.shape)) : point_query();
  const std::vector<float>& inputs = made->sample.drape.inputs;
  made->condition.assign(inputs.begin(), inputs.end() - static_cast<std::ptrdiff_t>(path.style.size()));
  return made;
}

}  // namespace

AskDistance DrapeBody::accurate() {
  return [this](const Points& at, std::vector<SignedDistance>& found) { field->ask(at, faces, found); };
}

AskDistance DrapeBody::by_network() {
  return [this](const Points& at, std::vector<SignedDistance>& found) { neural->ask(at, found); };
}

DrapeLessons make_drape_lessons(const std::filesystem::path& drapes, int validation_paths, bool bones) {
  DrapeLessons lessons{std::make_unique<const DrapeSet>(read_drape_set(drapes)), {}, {}, {}, {}};
  const DrapeWorld& world = lessons.set->world;
  lessons.ring = adjacency_of(world.surface.vertex_count, world.surface.edges);
  const auto paths = static_cast<int>(lessons.set->training.size());
  const auto add = [&](const DrapePath& path, std::vector<std::unique_ptr<DrapeBody>>& to) {
    for (std::size_t k = 0; k < path.x.size(); ++k) to.push_back(make_drape_body(world, path, k, bones));
  };
  for (int k = 0; k < paths; ++k)
    add(lessons.set->training[static_cast<std::size_t>(k)],
        k < paths - validation_paths ? lessons.training : lessons.validation);
  for (const DrapePath& path : lessons.set->test) add(path, lessons.test);
  if (lessons.training.empty() || lessons.validation.empty() || lessons.test.empty())
    throw Error("the training, validation or test part has no drapes", drapes.string(),
                "make more paths, or keep fewer for `validation_paths`");
  return lessons;
}

void use_network(const PlainNetwork& network, DrapeLessons& lessons) {
  for (auto* part : {&lessons.training, &lessons.validation, &lessons.test})
    for (const std::unique_ptr<DrapeBody>& body : *part)
      body->neural = std::make_unique<NeuralDistance>(network, body->query, body->condition);
}

}  // namespace selvedge
