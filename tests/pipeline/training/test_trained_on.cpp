#include <catch2/catch.hpp>

#include <sstream>

#include "learned/network/weights_hdf5.hpp"
#include "pipeline/compare/compare.hpp"
#include "pipeline/training/train.hpp"
#include "tests/pipeline/training/own_data.hpp"

namespace selvedge::test_trained_on {

using fake::has;
using fake::OwnData;

TEST_CASE("trained on: what is held out is not trained on, and compared on", "[training][compare]") {
  const OwnData own("trained_on");
  fake::write(own.folder, "split.yaml", "test: ['*kick']\n");
  std::ostringstream log;
  int asked = 0;
  const TrainRequest request{own.write("  split: split.yaml\n"), {}, own.folder.path / "run", false, &log,
                             [&asked] { return ++asked == 2; }};
  train(request);
  CHECK(has(log.str(), "trains on `anna`: 1 to wear, 1 bodies, 1 clips"));
  CHECK(has(log.str(), "held out: 1 of the clips in test"));
  CHECK_FALSE(has(fake::whole(request.out / "weights.h5"), own.folder.path.string()));  // paths travel

  const auto comparison = [&](const std::string& training, const std::string& split) {
    fake::write(own.folder, "compare.yaml",
                "sequences: {training: " + training + ", split: " + split +
                    ", frames: 2, file: " + (config_folder() / "evaluation" / "garment.yaml").string() +
                    "}\n"
                    "weights_folder: run\nrepeats: 1\njudged_frames: 0\n"
                    "settings: [{name: own, stepper: learned, weights: weights.h5}]\n");
    std::ostringstream told;
    CompareRequest compared;
    compared.file = own.folder.path / "compare.yaml";
    compared.out = own.folder.path / "compared";
    compared.log = &told;
    const CompareResult result = compare(compared);
    return std::pair{result, told.str()};
  };
  const auto [result, told] = comparison("own.yaml", "test");
  INFO(told);
  CHECK(has(told, "1 of 1 of the split `test`"));
  CHECK(has(told, "held out: clip moves/kick"));
  CHECK(has(told, "row `own`: weights.h5 was trained on `anna`: to wear skirt; clips moves/swing"));
  CHECK_FALSE(has(told, "warning"));
  REQUIRE(result.rows.size() == 1);
  CHECK(result.rows[0].scene == "anna_skirt_moves_kick");
  CHECK(result.rows[0].trouble.empty());

  // Another split, by which the clip of the training is held out, whatever it is called there.
  own.write("  split: {test: [moves/swing], validation: ['*kick']}\n", "other.yaml");
  CHECK_THROWS_WITH(comparison("other.yaml", "test"),
                    Catch::Contains("the row `own` were trained on the clip `moves/swing`, which is held out") &&
                        Catch::Contains("weights.h5") && Catch::Contains("cure: train with the `split` of other.yaml"));
  CHECK(has(comparison("other.yaml", "validation").second, "held out: clip moves/kick"));
  WeightFile weights = read_weight_file(request.out / "weights.h5");
  const TrainedOn on = read_trained_on(weights.trained_on, "weights");
  CHECK(on.whole);

  // Weights that say nothing are warned of; so are those that began with such.
  weights.trained_on.clear();
  write_weight_file(request.out / "weights.h5", weights);
  CHECK(has(comparison("other.yaml", "test").second, "warning: row `own`: weights.h5 has no record of its training"));
  TrainedOn later = on;
  add_earlier("", "earlier", later);
  weights.trained_on = trained_on_json(later);
  write_weight_file(request.out / "weights.h5", weights);
  CHECK(has(comparison("own.yaml", "test").second,
            "warning: row `own`: weights.h5 began with weights that have no record"));
}

TEST_CASE("trained on: it is known by content", "[training]") {
  const auto person = [](const std::string& name, std::uint64_t body, std::uint64_t wear, std::uint64_t clip) {
    return TrainedPerson{name, body, {{name + "'s skirt", wear}}, {{name + "'s clip", clip}}};
  };
  const TrainedOn on = read_trained_on(trained_on_json({{person("anna", 1, 2, 3)}, true}), "test");
  REQUIRE(on.people.size() == 1);
  const auto seen = [&](const TrainedPerson& who, bool body, bool wear, bool clip) {
    return seen_in_training(on, {who, body, wear, clip});
  };
  CHECK(seen(person("ben", 1, 9, 3), false, false, true) == "the clip `ben's clip`");
  CHECK(seen(person("ben", 1, 2, 9), false, true, false) == "`ben's skirt`, which is worn");
  CHECK(seen(person("ben", 1, 2, 9), false, false, true).empty());  // the skirt is not held out
  CHECK(seen(person("anna", 1, 9, 9), true, false, false) == "the person `anna`");
  CHECK(seen(person("ben", 1, 2, 3), true, false, false) == "the person `ben`");
  CHECK(seen(person("ben", 1, 2, 9), true, false, false).empty());   // another clip of the body's model
  CHECK(seen(person("anna", 9, 2, 3), true, false, false).empty());  // of the same name
  CHECK_THROWS_WITH(read_trained_on("{}", "file.h5"), Catch::Contains("file.h5"));
}

}  // namespace selvedge::test_trained_on
