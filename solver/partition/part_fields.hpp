// SPDX-License-Identifier: BSD-3-Clause
// Serialisation of a part as a stream of bytes, for messages between ranks and for files; and MPI messages of
// any length, sent in pieces because MPI counts are 32-bit.
#pragma once

#include <mpi.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <variant>

#include <kacanov/part.hpp>

namespace kacanov {

inline constexpr std::size_t longest_message = std::size_t{1} << 30;

inline void send_bytes(const void* data, std::size_t bytes, int to, MPI_Comm comm) {
  const char* p = static_cast<const char*>(data);
  for (std::size_t at = 0; at < bytes; at += longest_message)
    MPI_Send(p + at, static_cast<int>(std::min(longest_message, bytes - at)), MPI_BYTE, to, 1, comm);
}

inline void receive_bytes(void* data, std::size_t bytes, int from, MPI_Comm comm) {
  char* p = static_cast<char*>(data);
  for (std::size_t at = 0; at < bytes; at += longest_message)
    MPI_Recv(p + at, static_cast<int>(std::min(longest_message, bytes - at)), MPI_BYTE, from, 1, comm,
             MPI_STATUS_IGNORE);
}

/// std::vector, std::string: contiguous and resizable.
template <class T>
concept Sequence = requires(T values) {
  typename T::value_type;
  values.data();
  values.resize(1);
};

/// Numbers, arrays of numbers and structs of integers without padding, whose bytes would be indeterminate.
template <class T>
inline constexpr bool without_holes =
    std::is_arithmetic_v<T> || std::is_enum_v<T> || std::has_unique_object_representations_v<T>;
template <class T, std::size_t n>
inline constexpr bool without_holes<std::array<T, n>> = without_holes<T>;

/// Writes values to a sink with `write(const void* data, std::size_t bytes)`. A sequence is written as its
/// length (8 bytes) and its entries; types without padding as in memory, so that equal values give equal
/// bytes; everything else by its exchange_fields.
template <class Sink>
class FieldWriter {
 public:
  explicit FieldWriter(Sink& sink) : sink_(sink) {}
  template <class... T>
  requires(sizeof...(T) > 1) void operator()(const T&... values) const { ((*this)(values), ...); }
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

/// Reads the output of FieldWriter from a source with `read(void* data, std::size_t bytes)`. Before it
/// allocates a sequence it calls `expect(std::uint64_t entries, std::size_t bytes_each)`, which throws if the
/// source cannot contain that much.
template <class Source>
class FieldReader {
 public:
  explicit FieldReader(Source& source) : source_(source) {}
  template <class... T>
  requires(sizeof...(T) > 1) void operator()(T&... values) const { ((*this)(values), ...); }
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
    } else if constexpr (std::is_same_v<T, bool>) {
      std::uint8_t byte = 0;  // in a damaged file it may have any value
      source_.read(&byte, 1);
      value = byte != 0;
    } else if constexpr (without_holes<T>) {
      source_.read(&value, sizeof(T));
    } else {
      exchange_fields(value, *this);
    }
  }

 private:
  Source& source_;
};

// One list of fields serves both directions. Changing a list or its order requires a new version of the files
// in tools/program/part_files.cpp.

template <class T, class Struct>
concept Either = std::is_same_v<std::remove_const_t<T>, Struct>;  ///< Struct or const Struct

/// Returns a default form of the alternative with this index in the variant.
template <std::size_t i = 0>
Law::Form law_form(std::size_t number) {
  if constexpr (i + 1 < std::variant_size_v<Law::Form>)
    if (number != i) return law_form<i + 1>(number);
  return std::variant_alternative_t<i, Law::Form>{};
}

void exchange_fields(Either<Law> auto& law, const auto& stream) {
  auto form = static_cast<std::uint8_t>(law.form.index());
  stream(form, law.argument, law.mean_dilatation, law.bulk, law.shear);
  if constexpr (!std::is_const_v<std::remove_reference_t<decltype(law)>>) law.form = law_form(form);
  std::visit([&](auto& f) { f.parameters(f, stream); }, law.form);
}

void exchange_fields(Either<IndexMap::Neighbour> auto& n, const auto& stream) {
  stream(n.rank, n.shared, n.send, n.receive);
}

void exchange_fields(Either<IndexMap> auto& map, const auto& stream) {
  stream(map.owned, map.starts, map.ghosts, map.neighbours, map.shared);
}

void exchange_fields(Either<ContactPoint> auto& point, const auto& stream) {
  stream(point.node, point.entry, point.loose_piece, point.normal, point.outer, point.tangent, point.tangents,
         point.gap, point.unknown_gap, point.mass, point.tresca, point.coulomb, point.since_step);
}

void exchange_fields(Either<RowEntry> auto& entry, const auto& stream) {
  stream(entry.node, entry.normal, entry.trace, entry.tangent);
}

void exchange_fields(Either<ConstraintRows> auto& rows, const auto& stream) {
  ConstraintRows::exchange(rows, stream);
}

void exchange_fields(Either<Probe> auto& probe, const auto& stream) {
  stream(probe.point, probe.element, probe.weights);
}

void exchange_fields(Either<Part::ComponentValue> auto& entry, const auto& stream) {
  stream(entry.component, entry.value);
}

void exchange_fields(Either<LoadFactors> auto& factors, const auto& stream) {
  stream(factors.time, factors.boundary, factors.contact);
}

void exchange_fields(Either<EntryForce> auto& force, const auto& stream) {
  stream(force.component, force.entry, force.value);
}

void exchange_fields(Either<PointShare> auto& share, const auto& stream) {
  stream(share.point, share.entry, share.share);
}

void exchange_fields(Either<AppliedLoad> auto& load, const auto& stream) {
  stream(load.entry, load.total.force, load.total.moment);
}

void exchange_fields(Either<HeldDirection> auto& held, const auto& stream) {
  stream(held.node, held.entry, held.direction, held.value);
}

void exchange_fields(Either<NodeSpring> auto& spring, const auto& stream) {
  stream(spring.node, spring.entry, spring.stiffness);
}

void exchange_fields(Either<LoosePiece> auto& piece, const auto& stream) {
  stream(piece.name, piece.centre, piece.radius, piece.by_displacement);
}

void exchange_fields(Either<ThermalPressure> auto& thermal, const auto& stream) {
  stream(thermal.entry, thermal.of_element);
}

void exchange_fields(Either<IndexRuns> auto& indices, const auto& stream) {
  stream(indices.runs, indices.count);
}

void exchange_fields(Either<Part> auto& part, const auto& stream) {
  stream(part.type, part.plane, part.thickness, part.coordinates, part.elements, part.node_index,
         part.element_index, part.node_tags, part.element_tags, part.node_map, part.total_elements, part.laws,
         part.law_of_element, part.load, part.prescribed, part.steps, part.forces, part.prescribed_by,
         part.held, part.supports, part.applied, part.directions, part.springs, part.thermal, part.contact,
         part.owned_contact, part.contact_shares, part.wide_contact, part.contact_index, part.total_contact,
         part.probes, part.probe_index, part.total_probes, part.loose_modes, part.loose_pieces, part.start,
         part.no_equilibrium);
}

}  // namespace kacanov
