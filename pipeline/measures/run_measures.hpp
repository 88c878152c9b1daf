#pragma once

#include <map>
#include <string>
#include <vector>

#include "pipeline/measures/hood_measure.hpp"
#include "pipeline/measures/motion_measures.hpp"

namespace selvedge {

// The data of a frame that is measured.
struct MeasuredFrame {
  Points x;                 // of the cloth [m]
  Points body;              // of all obstacles, one after the other [m]; empty if there are none
  Points acceleration;      // of the cloth by all forces without contact [m/s2]
  int pairs = 0;            // of cloth triangles that intersect and share no vertex
  int body_pairs = 0;       // of a cloth's and an obstacle's triangle that intersect
  bool meets_body = false;  // a triangle of the cloth meets an obstacle, or a vertex lies in a closed one
  double depth = 0;         // of the deepest cloth vertex in a closed obstacle [m]
  bool crossed = false;     // an obstacle passes through itself
  int pushed_out = 0;       // number of vertices, by a response to obstacles
  double kinetic = 0;       // [J]
};

// Measures a run from its start, frame by frame.
class RunMeasures {
 public:
  // `judged`: for so many frames, spread over a run of `frames`, the distance to the optimum is found, which takes
  // seconds each.
  RunMeasures(const Scene&, int frames, int judged);

  void begin(const Points& x, const Points& body, int pairs);  // the start of the run
  void add(MeasuredFrame);

  // Values by name (docs/comparison.md): means over frames, unless meaning_of() says otherwise. Empty without frames.
  std::map<std::string, double> values() const;
  const std::vector<int>& pairs_by_frame() const { return pairs_; }  // the first is the start's

 private:
  void judge(const MeasuredFrame&);

  const Scene& scene_;
  int wanted_, judged_;
  HoodJudge judge_;
  JudgedFrame last_;  // the frame before, and the one before that
  int frames_ = 0, judged_so_far_ = 0, hood_frames_ = 0;
  std::map<std::string, double> sums_, mosts_;
  std::vector<int> pairs_;
  MotionTrace trace_;
  MotionSpectrum spectrum_;
  double jitter_squares_ = 0;
  int free_frames_ = 0;
};

// The meaning of a name of RunMeasures::values(); empty for an unknown name.
std::string meaning_of(const std::string& measure);

}  // namespace selvedge
