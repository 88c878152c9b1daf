#include "pipeline/motions/clip_amass.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "pipeline/bodies/body_smpl.hpp"
#include "pipeline/formats/npz.hpp"
#include "pipeline/shapes/motion.hpp"

namespace selvedge {
namespace {

using Eigen::Index;

[[noreturn]] void fail(const Npz& npz, const std::string& field, const std::string& what, const std::string& cure) {
  throw Error(what, npz.place(field).text(), cure);
}

// frames x columns; -1: any number.
NpyArray<double> table(const Npz& npz, const std::string& field, Index frames, Index columns) {
  NpyArray<double> array = npz.numbers(field);
  const std::vector<Index>& shape = array.shape;
  if (shape.size() != 2 || (frames >= 0 && shape[0] != frames) || (columns >= 0 && shape[1] != columns))
    fail(npz, field, fmt::format("has the shape ({})", fmt::join(shape, ", ")),
         fmt::format("a row a frame{}{}", frames >= 0 ? fmt::format(", {} of them", frames) : "",
                     columns >= 0 ? fmt::format(", with {} columns", columns) : ""));
  if (!std::all_of(array.values.begin(), array.values.end(), [](double value) { return std::isfinite(value); }))
    fail(npz, field, "is not finite", "repair the motion where it was made");
  return array;
}

struct RotationPart {
  std::string field;
  Index joints;
};

// The fields with the rotations, in the order of the joints' names.
std::vector<RotationPart> rotation_parts(const Npz& npz) {
  if (!npz.has("root_orient") && npz.has("poses")) {
    const NpyArray<double> poses = table(npz, "poses", -1, -1);
    const Index columns = poses.shape[1];
    if (columns != 72 && columns != 156 && columns != 165)
      fail(npz, "poses", fmt::format("has {} columns", columns), "known are SMPL (72), SMPL+H (156) and SMPL-X (165)");
    return {{"poses", columns / 3}};
  }
  if (!npz.has("root_orient"))
    fail(npz, "poses", "is missing, and so is `root_orient`", "it is no AMASS file, or only a part of one");
  std::vector<RotationPart> parts = {{"root_orient", 1}, {"pose_body", 21}};
  if (!npz.has("pose_hand")) return parts;
  // Without a jaw and eyes the joints are those of SMPL+H.
  if (npz.has("pose_jaw") && npz.has("pose_eye")) parts.insert(parts.end(), {{"pose_jaw", 1}, {"pose_eye", 2}});
  parts.push_back({"pose_hand", 30});
  return parts;
}

double frame_rate(const Npz& npz) {
  // SMPL+H files spell it without the second stroke.
  const std::string field = npz.has("mocap_framerate") ? "mocap_framerate" : "mocap_frame_rate";
  const NpyArray<double> rate = npz.numbers(field);
  if (rate.values.size() != 1 || !(rate.values[0] > 0) || !(rate.values[0] <= 1e6))
    fail(npz, field, "is no frame rate", "one number above 0, up to 1e6 frames a second");
  return rate.values[0];
}

// The shapes of a body: one row, or one row per frame.
Eigen::MatrixXd shapes_of(const Npz& npz, int most) {
  if (!npz.has("betas")) return {};
  const NpyArray<double> betas = npz.numbers("betas");
  const Index rows = betas.shape.size() == 2 ? betas.shape[0] : 1, count = static_cast<Index>(betas.values.size());
  const bool fits = betas.shape.size() == 1 || betas.shape.size() == 2;
  if (!fits || rows < 1 || !std::ranges::all_of(betas.values, [](double value) { return std::isfinite(value); }))
    fail(npz, "betas", fmt::format("has the shape ({}), or is not finite", fmt::join(betas.shape, ", ")),
         "the shape of one body: a row of finite numbers, or one a frame");
  if (const NpyArray<double> trans = rows > 1 ? npz.numbers("trans") : NpyArray<double>{};
      rows > 1 && (trans.shape.empty() || trans.shape[0] != rows))
    fail(npz, "betas", fmt::format("has {} rows", rows), "the shape of one body: one row, or one a frame");
  return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(betas.values.data(),
                                                                                                  rows, count / rows)
      .leftCols(std::min<Index>(most, count / rows));
}

Eigen::VectorXd first_row(const Eigen::MatrixXd& shapes) {
  return shapes.rows() == 0 ? Eigen::VectorXd() : Eigen::VectorXd(shapes.row(0).transpose());
}

void warn_of_length(const Npz& npz, Index frames, double fps, std::vector<std::string>& warnings) {
  if (!npz.has("mocap_time_length")) return;
  const NpyArray<double> length = npz.numbers("mocap_time_length");
  const double is = static_cast<double>(frames) / fps;
  if (length.values.size() == 1 && std::abs(length.values[0] - is) <= 2 / fps) return;
  warnings.push_back(fmt::format(
      "{} is {} s, and {} frames at {:g} a second are {:.4g} s: the frames and their rate "
      "are taken",
      npz.place("mocap_time_length").text(), length.values.empty() ? 0 : length.values[0], frames, fps, is));
}

// No joint turns twice. The root, the first of each frame's, may: some files count its turns on.
void warn_of_degrees(const Npz& npz, const std::string& field, const Points& rotations, Index joints,
                     std::vector<std::string>& warnings) {
  double most = 0;
  for (Index k = 0; k < rotations.rows(); ++k)
    if (k % joints != 0) most = std::max(most, rotations.row(k).norm());
  if (most > 4 * std::numbers::pi)
    warnings.push_back(
        fmt::format("{} turns a joint by {:.3g} rad: are the file's angles in degrees? They are taken as "
                    "radians",
                    npz.place(field).text(), most));
}

}  // namespace

Eigen::VectorXd read_amass_shape(const std::filesystem::path& path, std::vector<std::string>& warnings, int most) {
  const Npz npz(path);
  const Eigen::MatrixXd shapes = shapes_of(npz, most);
  if (shapes.rows() > 1)
    if (const double differs = (shapes.rowwise() - shapes.row(0)).cwiseAbs().maxCoeff(); differs > 1e-6)
      warnings.push_back(
          fmt::format("{} changes from frame to frame, by {:.3g} at most; a body keeps its shape, which "
                      "is that of frame 0",
                      npz.place("betas").text(), differs));
  return first_row(shapes);
}

Clip read_amass(const std::filesystem::path& path, const Vec3& pelvis, std::vector<std::string>& warnings, int shapes) {
  const Npz npz(path);
  const std::vector<RotationPart> parts = rotation_parts(npz);
  const NpyArray<double> trans = table(npz, "trans", -1, 3);
  const Index frames = trans.shape[0];
  if (frames == 0) fail(npz, "trans", "has no frames", "leave the file out, or write it anew where it was made");

  Index joints = 0;
  for (const RotationPart& part : parts) joints += part.joints;
  Points rotations(frames * joints, 3);
  Index first = 0;
  for (const RotationPart& part : parts) {
    const NpyArray<double> values = table(npz, part.field, frames, 3 * part.joints);
    for (Index f = 0; f < frames; ++f)
      rotations.middleRows(f * joints + first, part.joints) =
          Eigen::Map<const Points>(values.values.data() + f * 3 * part.joints, part.joints, 3);
    first += part.joints;
  }
  warn_of_degrees(npz, parts.back().field, rotations, joints, warnings);

  std::vector<std::string> names = smpl_joint_names(static_cast<int>(joints == 22 ? 24 : joints));
  names.resize(static_cast<std::size_t>(joints));
  Clip clip{path.stem().string(), frame_rate(npz), std::move(names), {}, first_row(shapes_of(npz, shapes))};
  warn_of_length(npz, frames, clip.fps, warnings);
  Mat3 y_up;
  y_up << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  for (Index f = 0; f < frames; ++f) {
    BodyPose pose{rotations.middleRows(f * joints, joints), Vec3::Zero()};
    const Vec3 at = Eigen::Map<const Vec3>(trans.values.data() + 3 * f);
    pose.rotations.row(0) = rotation_vector(y_up * rotation_matrix(row(pose.rotations, 0))).transpose();
    pose.translation = y_up * (pelvis + at) - pelvis;
    clip.poses.push_back(std::move(pose));
  }
  return clip;
}

}  // namespace selvedge
