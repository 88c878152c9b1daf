#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "pipeline/training/trainer.hpp"
#include "tests/pipeline/fake_smpl.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/pipeline/training/small_person.hpp"
#include "tests/pipeline/training/tiny_training.hpp"
#include "tests/refusal.hpp"

// A folder with a user's own data for training.
namespace selvedge::fake {

// An AMASS file with 60 frames per second, in which the right thigh swings by `size` [rad].
inline void write_amass(const std::filesystem::path& path, std::size_t frames, double size, double first_beta = 0) {
  std::vector<double> poses(frames * 156, 0.0), trans(frames * 3, 0.0), betas(16, 0.0);
  betas[0] = first_beta;
  for (std::size_t f = 0; f < frames; ++f) poses[f * 156 + 6] = size * std::sin(0.2 * static_cast<double>(f));
  write_npz(path, {{"poses", npy<double>({frames, 156}, poses)},
                   {"trans", npy<double>({frames, 3}, trans)},
                   {"betas", npy<double>({16}, betas)},
                   {"mocap_framerate", npy<double>({}, {60.0})}});
}

// A small body as a SMPL file, a skirt as OBJ, two clips, and a training file that takes them.
struct OwnData {
  Folder folder;
  std::filesystem::path training;

  explicit OwnData(const std::string& name) : folder(name) {
    BodyModel body = small_body();
    body.skin.pose_directions = Eigen::MatrixXd::Zero(3 * body.skin.rest.rows(), 9 * 23);
    write_npz(folder.path / "body.npz", published<float, std::uint32_t>(body));
    const Mesh skirt = small_skirt();
    write_obj(folder.path / "skirt.obj", 100 * skirt.x, skirt.triangles);
    std::filesystem::create_directory(folder.path / "moves");
    write_amass(folder.path / "moves" / "swing.npz", 40, 0.3);
    write_amass(folder.path / "moves" / "kick.npz", 40, 0.5);
    training = write("");
  }
  std::filesystem::path write(const std::string& split, const std::string& name = "own.yaml") const {
    return fake::write(folder, name,
                       "base: " + (config_folder() / "training" / "tiny.yaml").string() +
                           "\n"
                           "steps: 40\n"
                           "pool: {states: 2}\n"
                           "optimiser: {warm_up: 2}\n"
                           "watch: {fixed_states: 1, frames: 2}\n"
                           "samples:\n"
                           "  garments: none\n"
                           "  flesh: false\n"
                           "  people:\n"
                           "    - name: anna\n"
                           "      body: {model: body.npz}\n"
                           "      clips: ['moves/*.npz']\n"
                           "      wear: [{garments: [{file: skirt.obj, unit: cm}]}]\n" +
                           split);
  }
  std::string error(const std::vector<std::string>& overrides, const std::string& split = "") const {
    return testing::refusal([&] { make_training_world(read_training(write(split), overrides).samples, 1); });
  }
};

}  // namespace selvedge::fake
