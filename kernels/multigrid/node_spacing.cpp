// SPDX-License-Identifier: BSD-3-Clause
// Node spacing of a body.
#include "multigrid/node_spacing.hpp"

#include <cmath>

namespace kacanov {
namespace {

/// Ratio of nodes to elements in a body, far from its surface.
double nodes_an_element(ElementType type) {
  switch (type) {
    case ElementType::tet4: return 1.0 / 6.0;
    case ElementType::tet10: return 8.0 / 6.0;
    case ElementType::tri3: return 0.5;
    case ElementType::quad4:
    case ElementType::hex8: break;
  }
  return 1.0;
}

}  // namespace

std::vector<double> node_spacings(const Body& body, const IndexMap& nodes) {
  const std::size_t count = body.mesh.node_count(), npe = nodes_per_element(body.mesh.type);
  std::vector<double> sums(2 * count, 0.0), volume(body.mesh.element_count()), spacing(count);
  reference::volumes(body, volume);
  const double share = 1.0 / nodes_an_element(body.mesh.type), power = 1.0 / dimension(body.mesh.type);
  for (std::size_t e = 0; e < volume.size(); ++e)
    for (std::size_t a = 0; a < npe; ++a) {
      double* to = &sums[2 * static_cast<std::size_t>(body.mesh.connectivity[e * npe + a])];
      to[0] += std::pow(share * std::abs(volume[e]), power), to[1] += 1.0;
    }
  nodes.sum(sums, 2);
  for (std::size_t n = 0; n < count; ++n)
    spacing[n] = sums[2 * n + 1] > 0.0 ? sums[2 * n] / sums[2 * n + 1] : 0.0;
  return spacing;
}

}  // namespace kacanov
