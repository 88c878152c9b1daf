#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "pipeline/config/options.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_options {

using namespace selvedge::table;
using Catch::Matchers::Contains;
using fake::Folder;

namespace {

enum class Colour { red, green };

struct Lamp {
  double power = 0.5;
};

struct Stage {
  double width = 0.1;
  std::optional<double> fog;
  int rows = 3;
  std::optional<int> seats;
  std::uint64_t seed = 7;
  bool open = true;
  Colour colour = Colour::green;
  std::string title;
  std::string kind = "round";
  std::string folder;
  Vec3 towards{0, 1, 0.5};
  std::vector<double> steps{1, 2.5};
  std::vector<std::string> players{"a", "b"};
  Lamp spot{2}, flood;
};

const OptionRows<Lamp>& lamp_rows() {
  static const OptionRows<Lamp> rows{number("power", &Lamp::power, Unit::none, not_negative, "how bright")};
  return rows;
}

const Options<Lamp>& lamp_options() {
  static const Options<Lamp> table("flood", "One lamp.", lamp_rows());
  return table;
}

const Options<Stage>& stage_options() {
  using O = Stage;
  static const Options<O> table(
      "stage", "A stage.",
      OptionRows<O>{
          number("width", &O::width, Unit::length, positive, "across"),
          number("fog", &O::fog, Unit::none, {.low = 0, .high = 1}, "left out: none"),
          integer("rows", &O::rows, at_least_one, "of seats"),
          or_word(integer("seats", &O::seats, at_least_one, "in a row"), "auto"),
          integer("seed", &O::seed, not_negative, "of what is random"), flag("open", &O::open, "to all"),
          choice("colour", &O::colour, {{"red", Colour::red}, {"green", Colour::green}}, "of the curtain"),
          text("title", &O::title, "of the play"), word("kind", &O::kind, {"round", "square"}, "of the floor"),
          path("folder", &O::folder, "for photographs"), vector("towards", &O::towards, Unit::none, "where it looks"),
          numbers("steps", &O::steps, positive, "up to it"), texts("players", &O::players, "on it"),
          integer("by_hand", not_negative, "4", "read elsewhere")} +
          inside(&O::spot, lamp_rows()) + OptionRows<O>{section(&O::flood, lamp_options(), "of the back")});
  return table;
}

Config stage(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const Folder folder("options");
  return read_config(fake::write(folder, "stage.yaml", text), stage_options().section, overrides);
}

std::string refused_stage(const std::string& text) {
  try {
    stage(text);
    return {};
  } catch (const Error& e) {
    return e.what();
  }
}

const std::string all_given = R"(width: 20 cm
fog: 0.25
rows: 4
seats: 9
seed: 11
open: false
colour: red
title: Hamlet
kind: square
folder: photos
towards: [1, 2, 3]
steps: [4, 5]
players: [x]
by_hand: 6
power: 8
flood: {power: 9}
)";

}  // namespace

TEST_CASE("An option that is left out is what the struct's initialiser says", "[options]") {
  const Config config = stage("by_hand: 1\n");
  CHECK(config["width"].number() == 0.1);
  CHECK_FALSE(config["fog"].present());
  CHECK(config["seats"].text() == "auto");
  CHECK(config["colour"].text() == "green");
  CHECK(config["open"].flag());
  CHECK(config["towards"].vector() == Vec3(0, 1, 0.5));
  CHECK(config["steps"].numbers == std::vector<double>{1, 2.5});
  CHECK(config["players"].words == std::vector<std::string>{"a", "b"});
  CHECK_FALSE(config["title"].present());
  CHECK(config["power"].number() == 2);             // the outer struct's initialiser
  CHECK(config["flood"]["power"].number() == 0.5);  // the inner one's
  const Stage read = stage_options().read(config);
  CHECK(read.width == 0.1);
  CHECK_FALSE(read.fog);
  CHECK_FALSE(read.seats);
  CHECK(read.seed == 7);
  CHECK(read.kind == "round");
  CHECK(read.spot.power == 2);
}

TEST_CASE("Every kind of option is read into its member", "[options]") {
  const Config config = stage(all_given, {"rows=5", "flood.power=10"});
  const Stage read = stage_options().read(config);
  CHECK(read.width == Approx(0.2));
  CHECK(read.fog == 0.25);
  CHECK(read.rows == 5);
  CHECK(read.seats == 9);
  CHECK(read.seed == 11);
  CHECK_FALSE(read.open);
  CHECK(read.colour == Colour::red);
  CHECK(read.title == "Hamlet");
  CHECK(read.kind == "square");
  CHECK(read.folder == "photos");
  CHECK(read.towards == Vec3(1, 2, 3));
  CHECK(read.steps == std::vector<double>{4, 5});
  CHECK(read.players == std::vector<std::string>{"x"});
  CHECK(read.spot.power == 8);
  CHECK(read.flood.power == 10);
  CHECK(config["by_hand"].integer() == 6);
}

TEST_CASE("Only what is given replaces what a struct holds", "[options]") {
  Stage held;
  held.width = 3;
  held.rows = 8;
  held.seats = 2;
  read_options(stage_options().rows, stage("{rows: 9, seats: auto}\n"), held);
  CHECK(held.width == 3);
  CHECK(held.rows == 9);
  CHECK_FALSE(held.seats);
}

TEST_CASE("An option out of its bounds is refused with file, line and key", "[options]") {
  const auto [text, words] = GENERATE(Catch::Generators::table<std::string, std::vector<std::string>>({
      {"rows: 2\nwidth: 0\n", {"stage.yaml:2", "`width`", "above 0"}},
      {"width: 2 kg\n", {"stage.yaml:1", "`width`", "mm"}},
      {"fog: 1.5\n", {"`fog`", "from 0 to 1"}},
      {"rows: 0\n", {"`rows`", "an integer", "at least 1"}},
      {"rows: 1.5\n", {"`rows`", "not an integer"}},
      {"rows: 3000000000\n", {"`rows`", "is `3000000000`, beyond 2e9"}},
      {"seats: many\n", {"`seats`", "or auto"}},
      {"open: perhaps\n", {"`open`", "true or false"}},
      {"colour: grren\n", {"`colour`", "red, green", "did you mean `green`"}},
      {"kind: oval\n", {"`kind`", "round, square"}},
      {"towards: [1, 2]\n", {"`towards`", "2 items"}},
      {"steps: [1, -1]\n", {"`steps`", "above 0"}},
      {"flood: {power: -1}\n", {"`flood.power`", "at least 0"}},
      {"by_hand: -1\n", {"`by_hand`", "at least 0"}},
      {"wdith: 1\n", {"`wdith`", "did you mean `width`"}},
  }));
  const std::string message = refused_stage(text);
  INFO(text << " -> " << message);
  for (const std::string& word : words) CHECK_THAT(message, Contains(word));
}

TEST_CASE("Options document themselves", "[options]") {
  CHECK_THAT(
      section_chapter(stage_options().section),
      Catch::Matchers::EndsWith("| key | value | unit | allowed | default | meaning |\n|---|---|---|---|---|---|\n"
                                "| `width` | number | m | above 0 | `0.1` | across |\n"
                                "| `fog` | number |  | from 0 to 1 |  | left out: none |\n"
                                "| `rows` | integer |  | at least 1 | `3` | of seats |\n"
                                "| `seats` | integer or auto |  | at least 1 | `auto` | in a row |\n"
                                "| `seed` | integer |  | at least 0 | `7` | of what is random |\n"
                                "| `open` | true or false |  |  | `true` | to all |\n"
                                "| `colour` | red, green |  |  | `green` | of the curtain |\n"
                                "| `title` | text |  |  |  | of the play |\n"
                                "| `kind` | round, square |  |  | `round` | of the floor |\n"
                                "| `folder` | path |  |  |  | for photographs |\n"
                                "| `towards` | [x, y, z] |  |  | `[0, 1, 0.5]` | where it looks |\n"
                                "| `steps` | number or list of numbers |  | above 0 | `[1, 2.5]` | up to it |\n"
                                "| `players` | text or list of texts |  |  | `[a, b]` | on it |\n"
                                "| `by_hand` | integer |  | at least 0 | `4` | read elsewhere |\n"
                                "| `power` | number |  | at least 0 | `2` | how bright |\n"
                                "| `flood` | see [flood](#flood) |  |  | `{}` | of the back |\n"
                                "\n"));
}

TEST_CASE("Options print what reads back to them", "[options]") {
  const Stage first = stage_options().read(stage(all_given));
  const std::string printed = to_yaml(stage_options().written(first));
  const Stage again = stage_options().read(stage(printed));
  CHECK(to_yaml(stage_options().written(again)) == printed);
  CHECK(again.seats == 9);
  CHECK(again.colour == Colour::red);
  CHECK(again.flood.power == 9);
  CHECK(again.towards == first.towards);
  const std::string plain = to_yaml(stage_options().written({}));
  CHECK_THAT(plain, Contains("seats: auto"));
  CHECK_THAT(plain, !Contains("fog"));
  CHECK_FALSE(stage_options().read(stage(plain)).seats);
}

}  // namespace selvedge::test_options
