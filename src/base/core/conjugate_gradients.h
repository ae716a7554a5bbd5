#pragma once

#include <cstddef>
#include <vector>

namespace octafront {

/// When conjugate gradients end.
struct SolverLimits {
  int steps;
  double enough;  ///< of the first residual, squared, both in the norm of the inverse diagonal
};

/// Solves times(x) = residual by conjugate gradients, scaled by the diagonal: `times` multiplies by a symmetric matrix
/// without negative eigenvalues. Rows of zeros have no part in it; a singular matrix may be given where the right side
/// fits. Hestenes and Stiefel 1952.
template <class Times>
std::vector<double> solved_by_conjugate_gradients(const std::vector<double>& diagonal, std::vector<double> residual,
                                                  const Times& times, const SolverLimits& limits) {
  const std::size_t n = residual.size();
  std::vector<double> x(n, 0), p(n, 0), z(n);
  const auto scale = [&] {
    for (std::size_t i = 0; i < n; ++i) z[i] = diagonal[i] > 0 ? residual[i] / diagonal[i] : 0;
  };
  const auto product = [n](const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) sum += a[i] * b[i];
    return sum;
  };
  scale();
  double rz = product(residual, z), beta = 0;
  const double enough = limits.enough * rz;
  for (int step = 0; step < limits.steps && rz > enough; ++step) {
    for (std::size_t i = 0; i < n; ++i) p[i] = z[i] + beta * p[i];
    const std::vector<double> ap = times(p);
    const double curve = product(p, ap);
    if (!(curve > 0)) break;
    for (std::size_t i = 0; i < n; ++i) x[i] += rz / curve * p[i], residual[i] -= rz / curve * ap[i];
    scale();
    const double next = product(residual, z);
    beta = next / rz;
    rz = next;
  }
  return x;
}

}  // namespace octafront
