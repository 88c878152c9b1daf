#include <catch2/catch.hpp>

#include <cmath>

#include "pipeline/plots/plot_axis.hpp"
#include "pipeline/plots/plot_labels.hpp"

namespace selvedge::test_plots {

using Catch::Matchers::Contains;

namespace {

std::vector<std::string> labels_of(const std::vector<PlotTick>& ticks) {
  std::vector<std::string> labels;
  for (const PlotTick& tick : ticks) labels.push_back(tick.label);
  return labels;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

Plot decay(std::size_t points) {
  Plot plot{"decay", {"step"}, {"J", PlotScale::logarithmic}};
  plot.curves.push_back({"energy <b>", {}, {}});
  for (std::size_t k = 0; k < points; ++k) {
    plot.curves[0].x.push_back(static_cast<double>(k));
    plot.curves[0].y.push_back(std::exp(-0.1 * static_cast<double>(k)));
  }
  return plot;
}

}  // namespace

TEST_CASE("plots: ticks are round and apart from each other", "[plots]") {
  using Words = std::vector<std::string>;
  CHECK(labels_of(ticks_of(axis_for(PlotScale::linear, {0, 10}, 0, 600), 40)) == Words{"0", "2", "4", "6", "8", "10"});
  CHECK(labels_of(ticks_of(axis_for(PlotScale::linear, {97, 103}, 0, 600), 40)) ==
        Words{"97", "98", "99", "100", "101", "102", "103"});
  CHECK(labels_of(ticks_of(axis_for(PlotScale::logarithmic, {1, 100}, 0, 600), 40)) ==
        Words{"1", "2", "5", "10", "20", "50", "100"});
  CHECK(labels_of(ticks_of(axis_for(PlotScale::logarithmic, {1e-8, 1}, 0, 900), 40)).size() == 9);
  CHECK(labels_of(ticks_of(axis_for(PlotScale::counts, {0, 9}, 0, 600), 40)).front() == "0");
  for (const std::vector<double>& values : {std::vector<double>{3.1, 3.2}, {5, 5}, {1e-7, 3e-7}, {-4, 12}, {1e6, 5e7}})
    for (const PlotScale scale : {PlotScale::linear, PlotScale::logarithmic}) {
      const DrawnAxis axis = axis_for(scale, values, 0, 300);
      const std::vector<PlotTick> ticks = ticks_of(axis, 20);
      INFO(values[0] << " to " << values[1]);
      CHECK(ticks.size() >= 1);
      CHECK(ticks.size() <= 15);
      for (std::size_t k = 1; k < ticks.size(); ++k) CHECK(ticks[k].at - ticks[k - 1].at >= 20);
      for (const PlotTick& tick : ticks) CHECK((tick.at >= -1e-6 && tick.at <= 300 + 1e-6));
    }
}

TEST_CASE("plots: values lie inside of the axes, those that are not on the scale are left out", "[plots]") {
  const std::vector<double> values{std::nan(""), HUGE_VAL, -1, 0, 0.01, 20};
  const DrawnAxis axis = axis_for(PlotScale::logarithmic, values, 100, 0);
  CHECK_FALSE((axis.has(values[0]) || axis.has(values[1]) || axis.has(values[2]) || axis.has(values[3])));
  CHECK((axis.place(0.01) < 100 && axis.place(20) > 0 && axis.place(0.01) > axis.place(20)));
  const DrawnAxis none = axis_for(PlotScale::logarithmic, {-1, 0}, 100, 0);
  CHECK(none.low > none.high);
  CHECK(axis_for(PlotScale::linear, {1, 10}, 0, 1).low == 0);
  CHECK(axis_for(PlotScale::linear, {8, 10}, 0, 1).low > 7);
}

TEST_CASE("plots: labels of points that lie close do not cover each other", "[plots]") {
  std::vector<PlotLabel> points;
  for (int k = 0; k < 6; ++k) points.push_back({"a name", 300 + 2.0 * k, 200 + 14.0 * k});
  points.push_back({"at the right edge", 590, 100});
  const PlotArea inside{70, 30, 604, 334};
  const std::vector<PlotLabel> placed = place_labels(points, inside);
  REQUIRE(placed.size() == points.size());
  for (std::size_t i = 0; i < placed.size(); ++i) {
    CHECK(placed[i].x >= inside.left);
    CHECK(placed[i].x + text_width(placed[i].text) <= inside.right);
    for (std::size_t j = 0; j < i; ++j) {
      INFO(i << " and " << j);
      const bool beside = placed[i].x >= placed[j].x + text_width(placed[j].text) ||
                          placed[j].x >= placed[i].x + text_width(placed[i].text);
      CHECK((beside || std::abs(placed[i].y - placed[j].y) >= 9.9));
    }
  }
  CHECK(text_width("m\xC2\xB2") == text_width("m2"));
}

TEST_CASE("plots: curves have a legend, names and numbers where the pointer rests, and dots where there are few",
          "[plots]") {
  const std::string few = plot_svg(decay(5)), many = plot_svg(decay(1000));
  for (const std::string& svg : {few, many})
    CHECK_THAT(svg, Contains("<polyline class='line'") && Contains("energy &lt;b&gt;</text>") &&
                        Contains("<title>energy &lt;b&gt;: 1 at 0</title>") && !Contains("<b>"));
  CHECK(count(few, "<circle fill=") == 5);
  CHECK(count(many, "<circle fill=") == 0);
  CHECK(count(many, "class='rest'") > 100);
  CHECK(many.size() < 60'000);
  CHECK(plot_svg({}).empty());
  Plot negative = decay(3);
  for (double& y : negative.curves[0].y) y = -y;
  CHECK(plot_svg(negative).empty());
}

TEST_CASE("plots: the failed stand at the upper edge, the front is a line, the floor an area", "[plots]") {
  Plot plot{"title", {"x", PlotScale::logarithmic}, {"y", PlotScale::logarithmic}};
  plot.points = {{"a", 10, 2, PlotMark::front, "a: 2 at 10"},
                 {"b", 20, std::nan(""), PlotMark::failed, ""},
                 {"c < d", 30, 3, PlotMark::unclean, ""}};
  plot.floor = 1;
  CHECK_THAT(plot_svg(plot), Contains("class='failed'") && Contains("class='floor'") && Contains("c &lt; d") &&
                                 Contains("class='front-line'") && Contains("<title>a: 2 at 10</title>"));
  plot.points = {plot.points[1]};
  CHECK(plot_svg(plot).empty());
}

TEST_CASE("plots: bars stand on zero, one a group and name", "[plots]") {
  const std::string svg = bars_svg({"bars", "group", {"1", "2"}, {{"first", {1, 2}}, {"second", {0, 4}}}});
  CHECK(count(svg, "<rect fill=") == 4);
  CHECK_THAT(svg, Contains("<title>second: 4 at 2</title>") && Contains(">first</text>"));
  CHECK(bars_svg({"bars", "group", {}, {}}).empty());
}

}  // namespace selvedge::test_plots
