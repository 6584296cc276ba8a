// SPDX-License-Identifier: BSD-3-Clause
// The fields of a part as one stream of bytes, the same for messages between ranks and for files.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "part.hpp"

namespace kacanov {

/// std::vector, std::string: entries one after another, resizable.
template <class T>
concept Sequence = requires(T values) {
  typename T::value_type;
  values.data();
  values.resize(1);
};

/// Numbers, arrays of them and structs of integers, none with holes, whose bytes nobody sets.
template <class T>
inline constexpr bool without_holes = std::is_arithmetic_v<T> || std::is_enum_v<T> || std::has_unique_object_representations_v<T>;
template <class T, std::size_t n>
inline constexpr bool without_holes<std::array<T, n>> = without_holes<T>;

/// Writes values to a sink with `write(const void* data, std::size_t bytes)`. A sequence goes as its length, 8 bytes, and its
/// entries; what is without holes as it lies in memory, so that equal values are equal bytes; everything else by its exchange_fields.
template <class Sink>
class FieldWriter {
 public:
  explicit FieldWriter(Sink& sink) : sink_(sink) {}
  template <class T>
  void operator()(const T& value) const {
    if constexpr (Sequence<T>) {
      using Entry = typename T::value_type;
      (*this)(static_cast<std::uint64_t>(value.size()));
      if constexpr (without_holes<Entry>)
        sink_.write(value.data(), value.size() * sizeof(Entry));
      else
        for (const Entry& entry : value) (*this)(entry);
    } else if constexpr (without_holes<T>) {
      sink_.write(&value, sizeof(T));
    } else {
      exchange_fields(value, *this);
    }
  }

 private:
  Sink& sink_;
};

/// Reads what FieldWriter has written from a source with `read(void* data, std::size_t bytes)`. Before it takes memory for a sequence it asks
/// `expect(std::uint64_t entries, std::size_t bytes_each)`, which throws where there cannot be as much.
template <class Source>
class FieldReader {
 public:
  explicit FieldReader(Source& source) : source_(source) {}
  template <class T>
  void operator()(T& value) const {
    if constexpr (Sequence<T>) {
      using Entry = typename T::value_type;
      constexpr bool plain = without_holes<Entry>;
      std::uint64_t entries = 0;
      (*this)(entries);
      source_.expect(entries, plain ? sizeof(Entry) : 1);
      value.resize(entries);
      if constexpr (plain)
        source_.read(value.data(), value.size() * sizeof(Entry));
      else
        for (Entry& entry : value) (*this)(entry);
    } else if constexpr (without_holes<T>) {
      source_.read(&value, sizeof(T));
    } else {
      exchange_fields(value, *this);
    }
  }

 private:
  Source& source_;
};

// One list of fields serves both directions. A change to one of them, or to the order, is a new version of the files in tools/part_files.cpp.

template <class L, class Stream>
  requires std::is_same_v<std::remove_const_t<L>, Law>
void exchange_fields(L& law, const Stream& stream) {
  stream(law.kind);
  stream(law.argument);
  stream(law.mean_dilatation);
  for (auto* x : {&law.bulk, &law.shear, &law.x0, &law.gamma, &law.n, &law.q}) stream(*x);
  stream(law.table_x);
  stream(law.table_s);
}

template <class N, class Stream>
  requires std::is_same_v<std::remove_const_t<N>, Halo::Neighbour>
void exchange_fields(N& n, const Stream& stream) {
  stream(n.rank);
  stream(n.shared);
  stream(n.send);
  stream(n.receive);
}

template <class C, class Stream>
  requires std::is_same_v<std::remove_const_t<C>, ContactPoint>
void exchange_fields(C& point, const Stream& stream) {
  stream(point.node);
  stream(point.entry);
  stream(point.normal);
  stream(point.trace);
  stream(point.tangent);
  stream(point.tangents);
  for (auto* x : {&point.gap, &point.mass, &point.tresca, &point.coulomb}) stream(*x);
}

template <class Q, class Stream>
  requires std::is_same_v<std::remove_const_t<Q>, Probe>
void exchange_fields(Q& probe, const Stream& stream) {
  stream(probe.point);
  stream(probe.element);
  stream(probe.weights);
}

template <class V, class Stream>
  requires std::is_same_v<std::remove_const_t<V>, Part::ComponentValue>
void exchange_fields(V& entry, const Stream& stream) {
  stream(entry.component);
  stream(entry.value);
}

template <class R, class Stream>
  requires std::is_same_v<std::remove_const_t<R>, IndexRuns>
void exchange_fields(R& indices, const Stream& stream) {
  stream(indices.runs);
  stream(indices.count);
}

template <class P, class Stream>
  requires std::is_same_v<std::remove_const_t<P>, Part>
void exchange_fields(P& part, const Stream& stream) {
  stream(part.type);
  stream(part.coordinates);
  stream(part.elements);
  stream(part.node_index);
  stream(part.element_index);
  stream(part.node_tags);
  stream(part.element_tags);
  stream(part.owned_nodes);
  stream(part.first_owned);
  stream(part.total_nodes);
  stream(part.total_elements);
  stream(part.ghost_number);
  stream(part.halo.neighbours);
  stream(part.halo.shared);
  stream(part.laws);
  stream(part.law_of_element);
  stream(part.load);
  stream(part.prescribed);
  stream(part.held);
  stream(part.contact);
  stream(part.owned_contact);
  stream(part.contact_index);
  stream(part.total_contact);
  stream(part.probes);
  stream(part.probe_index);
  stream(part.total_probes);
  stream(part.loose_modes);
}

}  // namespace kacanov
