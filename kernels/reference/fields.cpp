// SPDX-License-Identifier: BSD-3-Clause
// Stress, strain, volume and position of elements and their points at a displacement.
#include <kacanov/reference.hpp>

#include <algorithm>
#include <cmath>

#include "reference/element_points.hpp"

namespace kacanov::reference {

void volumes(const Body& body, std::span<double> volume) {
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    for (std::size_t e = 0; e < body.mesh.element_count(); ++e) {
      const Nodal<E> x = gather<E>(body, e, body.mesh.coordinates);
      volume[e] = 0.0;
      for (std::size_t q = 0; q < E::points; ++q) volume[e] += Point<E>(x, q, body.mesh.plane).volume;
    }
  });
}

void fields(const Body& body, std::span<const double> u, const ElementFields& out) {
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    const CornerDilatation means(body, u, body.corner_dilatation);
    for (std::size_t e = 0; e < body.mesh.element_count(); ++e) {
      const Law& law = body.law(e);
      const Nodal<E> x = gather<E>(body, e, body.mesh.coordinates);
      const Nodal<E> local = gather<E>(body, e, u);
      Sym tau{};
      double volume = 0.0, dev_strain = 0.0, g_mean = 0.0, von_mises = 0.0, largest = 0.0, rotation = 0.0;
      bool plastic = false;
      const auto points = points_of<E>(x, law.mean_dilatation, body.mesh.plane);
      for (std::size_t q = 0; q < E::points; ++q) {
        const Point<E>& point = points[q];
        Strain plane = strain_at<E>(point, local);
        means.put<E>(law, e, q, plane);
        const Strain strain = across<E>(body, e, q, plane);
        const double norm = strain.norm(), g = moduli_at<E>(body, e, q, norm).secant;
        const Sym point_tau = stress(law, g, strain);
        for (std::size_t i = 0; i < 6; ++i) tau[i] += point.volume * point_tau[i];
        volume += point.volume;
        dev_strain += point.volume * norm;
        g_mean += point.volume * g;
        von_mises += point.volume * std::sqrt(1.5) * 2.0 * g * norm;
        plastic = plastic || law.plastic(norm);
        if (out.strain.empty() && out.rotation.empty()) continue;
        Gradient h = gradient_at<E>(point, local);
        if (body.mesh.plane == PlaneState::stress)
          h[2][2] = strain.dev[2] + strain.trace / 3.0 + free_strain_of(body, e);
        largest = std::max(largest, largest_principal(h));
        rotation = std::max(rotation, rotation_angle(h));
      }
      if (!out.stress.empty())
        for (std::size_t i = 0; i < 6; ++i) out.stress[6 * e + i] = tau[i] / volume;
      if (!out.von_mises.empty()) out.von_mises[e] = von_mises / volume;
      if (!out.dev_strain.empty()) out.dev_strain[e] = dev_strain / volume;
      if (!out.secant.empty()) out.secant[e] = g_mean / volume;
      if (!out.plastic.empty()) out.plastic[e] = plastic ? 1 : 0;
      if (!out.strain.empty()) out.strain[e] = largest;
      if (!out.rotation.empty()) out.rotation[e] = rotation;
      if (!out.volume.empty()) out.volume[e] = volume;
    }
  });
}

void strains(const Body& body, std::span<const double> u, std::span<double> out) {
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    for_each_point<E>(body, u, body.corner_dilatation,
                      [&](std::size_t e, const Law&, std::size_t q, const Point<E>&, const Strain& plane) {
                        const Strain strain = across<E>(body, e, q, plane);
                        const double mean = strain.trace / 3.0 + free_strain_of(body, e);
                        for (std::size_t i = 0; i < 6; ++i)
                          out[6 * (e * E::points + q) + i] = strain.dev[i] + (i < 3 ? mean : 0.0);
                      });
  });
}

void points(const Body& body, std::span<double> position, std::span<double> weight) {
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    for (std::size_t k = 0; k < body.mesh.element_count() * E::points; ++k) {
      const std::size_t q = k % E::points;
      const Nodal<E> x = gather<E>(body, k / E::points, body.mesh.coordinates);
      if (!weight.empty()) weight[k] = Point<E>(x, q, body.mesh.plane).volume;
      const auto shape = E::values(E::point[q].data());
      for (std::size_t i = 0; i < E::dim && !position.empty(); ++i) {
        position[k * E::dim + i] = 0.0;
        for (int a = 0; a < E::nodes; ++a) position[k * E::dim + i] += shape[a] * x[a * E::dim + i];
      }
    }
  });
}

void point_fields(const Body& body, std::span<const double> u, const PointFields& out) {
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    for_each_point<E>(
        body, u, body.corner_dilatation,
        [&](std::size_t e, const Law& law, std::size_t q, const Point<E>& point, const Strain& plane) {
          const std::size_t k = e * E::points + q;
          const Strain strain = across<E>(body, e, q, plane);
          if (!out.stress.empty()) {
            const Sym tau = stress(law, moduli_at<E>(body, e, q, strain.norm()).secant, strain);
            std::copy(tau.begin(), tau.end(), &out.stress[6 * k]);
          }
          const double mean = strain.trace / 3.0 + free_strain_of(body, e);
          for (std::size_t i = 0; i < 6 && !out.strain.empty(); ++i)
            out.strain[6 * k + i] = strain.dev[i] + (i < 3 ? mean : 0.0);
          if (!out.volume.empty()) out.volume[k] = point.volume;
          if (out.position.empty()) return;
          const auto shape = E::values(E::point[q].data());
          const std::int32_t* node = nodes_of(body, e);
          out.position[k] = {};
          for (int a = 0; a < E::nodes; ++a)
            for (int i = 0; i < E::dim; ++i)
              out.position[k][i] += shape[a] * body.mesh.coordinates[Point<E>::at(node[a], i)];
        });
  });
}

}  // namespace kacanov::reference
