#include "pipeline/host/csv_columns.hpp"

#include <catch2/catch.hpp>

#include <cmath>

namespace selvedge::test_csv_columns {

TEST_CASE("A table by columns: what is no number, or not there, is no number", "[csv_columns]") {
  const CsvColumns table("a,b,c\n1,-2.5e3,nan\n,x,3\n4\n");
  CHECK(table.names == std::vector<std::string>{"a", "b", "c"});
  CHECK(table["a"][0] == 1);
  CHECK(std::isnan(table["a"][1]));
  CHECK(table["a"][2] == 4);
  CHECK(table["b"][0] == -2500);
  CHECK((std::isnan(table["b"][1]) && std::isnan(table["b"][2])));
  CHECK((std::isnan(table["c"][0]) && table["c"][1] == 3 && std::isnan(table["c"][2])));
  CHECK(table["d"].empty());
  CHECK(CsvColumns("").names.empty());
}

}  // namespace selvedge::test_csv_columns
