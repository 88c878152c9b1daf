#include <catch2/catch.hpp>

#include <cstdlib>
#include <fstream>

namespace {

// Appends a line for each beginning and end of a test case to the file named by SELVEDGE_TALLY, so that several
// processes can be counted together and a crashed case is noticed. A case that passes and warns WARN("skipped: why")
// counts as skipped.
class Tally : public Catch::TestEventListenerBase {
 public:
  using TestEventListenerBase::TestEventListenerBase;

  void testCaseStarting(const Catch::TestCaseInfo& info) override {
    skipped_.clear();
    write("began", info.name);
  }

  bool assertionEnded(const Catch::AssertionStats& stats) override {
    const Catch::AssertionResult& result = stats.assertionResult;
    if (result.getResultType() == Catch::ResultWas::Warning && result.getMessage().rfind("skipped", 0) == 0)
      skipped_ = result.getMessage();
    return true;
  }

  void testCaseEnded(const Catch::TestCaseStats& stats) override {
    if (!stats.totals.assertions.allOk())
      write("failed", stats.testInfo.name);
    else if (!skipped_.empty())
      write("skipped", stats.testInfo.name + " (" + skipped_ + ")");
    else
      write("passed", stats.testInfo.name);
  }

 private:
  static void write(const std::string& outcome, const std::string& name) {
    if (const char* path = std::getenv("SELVEDGE_TALLY"))
      std::ofstream(path, std::ios::app) << outcome + '\t' + name + '\n';
  }

  std::string skipped_;
};

CATCH_REGISTER_LISTENER(Tally)

}  // namespace
