#pragma once

namespace CLI {
class Validator;
}

namespace selvedge {

// Checks of an option's number, which refuse NaN and infinity. What they say is all that a message needs.
CLI::Validator above_zero();
CLI::Validator at_least_zero();

}  // namespace selvedge
