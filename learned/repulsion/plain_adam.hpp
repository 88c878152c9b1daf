#pragma once

#include <span>
#include <vector>

#include "learned/repulsion/plain_network.hpp"

namespace selvedge {

// Adam (Kingma and Ba 2015, algorithm 1) for a plain network. Moments are in the order of parameters_of.
struct PlainAdam {
  double rate = 1e-5, beta1 = 0.9, beta2 = 0.999, epsilon = 1e-8;
  double decay = 0;  // weight decay, times the rate (Loshchilov and Hutter 2019)
  long long steps = 0;
  std::vector<float> first, second;
};

// Takes one step. Returns false and changes nothing if the gradient is not finite.
bool take_step(PlainAdam&, std::span<const float> gradient, PlainNetwork&);

}  // namespace selvedge
