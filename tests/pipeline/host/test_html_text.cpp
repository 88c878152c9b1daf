#include "pipeline/host/html_text.hpp"

#include <catch2/catch.hpp>

namespace selvedge::test_html_text {

TEST_CASE("Text ends neither an element nor an attribute", "[html_text]") {
  CHECK(html_text("a <b> & 'c' \"d\"") == "a &lt;b&gt; &amp; &#39;c&#39; &quot;d&quot;");
  CHECK(html_text("caf\xC3\xA9, 3 m") == "caf\xC3\xA9, 3 m");
}

TEST_CASE("Text is one part of a URL", "[html_text]") {
  CHECK(url_text("run-1_a.b~c") == "run-1_a.b~c");
  CHECK(url_text("a/b?c#d%'\" <\xC3\xA9") == "a%2Fb%3Fc%23d%25%27%22%20%3C%C3%A9");
}

}  // namespace selvedge::test_html_text
