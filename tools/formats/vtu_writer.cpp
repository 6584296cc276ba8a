// SPDX-License-Identifier: BSD-3-Clause
// The XML around the arrays, and the arrays themselves as raw bytes at the end.
#include "formats/vtu_writer.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <sstream>

#include <kacanov/error.hpp>
#include "formats/atomic_file.hpp"
#include "formats/xml.hpp"

namespace kacanov {
namespace {

constexpr const char* byte_order = std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";

std::string header(const char* type) {
  return std::string("<?xml version=\"1.0\"?>\n<VTKFile type=\"") + type +
         "\" version=\"1.0\" byte_order=\"" + byte_order + "\" header_type=\"UInt64\">\n";
}

/// Components as written: two become three in 2D.
std::size_t written_components(const Grid& grid, const Field& field) {
  return grid.dim == 2 && field.components == 2 ? 3 : static_cast<std::size_t>(field.components);
}

struct FieldType {
  const char* name;
  std::size_t bytes;
};

FieldType field_type(const Field& field) {
  constexpr std::array<FieldType, 3> types{{{"Float64", 8}, {"Int64", 8}, {"UInt8", 1}}};
  return types[field.values.index()];
}

/// The attributes of a data array that .vtu and .pvtu share.
std::string array_attributes(const Grid& grid, const Field& field) {
  std::string text = std::string("type=\"") + field_type(field).name + "\" Name=\"" + xml_escape(field.name) +
                     "\" NumberOfComponents=\"" + std::to_string(written_components(grid, field)) + "\"";
  if (field.components == 6) {
    constexpr std::array<const char*, 6> names{"XX", "YY", "ZZ", "XY", "YZ", "XZ"};
    for (std::size_t k = 0; k < names.size(); ++k)
      text += " ComponentName" + std::to_string(k) + "=\"" + names[k] + "\"";
  }
  return text;
}

/// Writes converted values in large blocks.
template <typename T>
class Buffer {
 public:
  explicit Buffer(AtomicFile& file) : file_(file) { values_.reserve(capacity); }
  void push(T value) {
    values_.push_back(value);
    if (values_.size() == capacity) flush();
  }
  void flush() {
    file_.write(values_.data(), values_.size() * sizeof(T));
    values_.clear();
  }

 private:
  static constexpr std::size_t capacity = 1 << 14;
  AtomicFile& file_;
  std::vector<T> values_;
};

class VtuWriter {
 public:
  VtuWriter(const std::string& path, const Grid& grid)
      : path_(path),
        grid_(grid),
        nodes_(grid.cell->nodes),
        dim_(grid.dim),
        points_(grid.points.size() / dim_),
        cells_(grid.cells.size() / nodes_),
        file_(path) {}

  void write() {
    file_.write(header("UnstructuredGrid"));
    file_.write("<UnstructuredGrid>\n<Piece NumberOfPoints=\"" + std::to_string(points_) +
                "\" NumberOfCells=\"" + std::to_string(cells_) + "\">\n");
    declare_fields("PointData", grid_.point_fields, points_);
    declare_fields("CellData", grid_.cell_fields, cells_);
    file_.write("<Points>\n");
    declare("type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"", points_ * 3 * 8);
    file_.write("</Points>\n<Cells>\n");
    declare("type=\"Int32\" Name=\"connectivity\"", cells_ * nodes_ * 4);
    declare("type=\"Int64\" Name=\"offsets\"", cells_ * 8);
    declare("type=\"UInt8\" Name=\"types\"", cells_);
    file_.write("</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");
    for (const Field& field : grid_.point_fields) append(field);
    for (const Field& field : grid_.cell_fields) append(field);
    append_points();
    append_cells();
    file_.write("\n</AppendedData>\n</VTKFile>\n");
    file_.commit();
  }

 private:
  void declare(const std::string& attributes, std::size_t bytes) {
    file_.write("<DataArray " + attributes + " format=\"appended\" offset=\"" + std::to_string(offset_) +
                "\"/>\n");
    offset_ += sizeof(std::uint64_t) + bytes;
  }

  void declare_fields(const std::string& element, const std::vector<Field>& fields, std::size_t count) {
    file_.write("<" + element + ">\n");
    for (const Field& field : fields) {
      const std::size_t size = std::visit([](const auto& values) { return values.size(); }, field.values);
      if (size != count * static_cast<std::size_t>(field.components))
        throw InternalError(path_ + ": the field " + field.name + " has " + std::to_string(size) +
                            " values for " + std::to_string(count) + " times " +
                            std::to_string(field.components));
      declare(array_attributes(grid_, field),
              count * written_components(grid_, field) * field_type(field).bytes);
    }
    file_.write("</" + element + ">\n");
  }

  void append_size(std::uint64_t bytes) { file_.write(&bytes, sizeof bytes); }

  template <typename T>
  void append_padded(const Values<T>& values, std::size_t from, std::size_t to) {
    append_size(values.size() / from * to * sizeof(T));
    Buffer<T> buffer(file_);
    values.visit(entries_at_a_time * from, [&](std::span<const T> some) {
      if (from == to) {
        file_.write(some.data(), some.size_bytes());
        return;
      }
      for (std::size_t i = 0; i < some.size(); i += from)
        for (std::size_t k = 0; k < to; ++k) buffer.push(k < from ? some[i + k] : T{0});
    });
    buffer.flush();
  }

  void append(const Field& field) {
    std::visit(
        [&](const auto& values) {
          append_padded(values, field.components, written_components(grid_, field));
        },
        field.values);
  }

  void append_points() { append_padded(Values<double>(grid_.points.first(points_ * dim_)), dim_, 3); }

  void append_cells() {
    append_size(cells_ * nodes_ * 4);
    Buffer<std::int32_t> nodes(file_);
    for (std::size_t c = 0; c < cells_; ++c)
      for (const std::int8_t from : grid_.cell->vtk_order)
        nodes.push(grid_.cells[c * nodes_ + static_cast<std::size_t>(from)]);
    nodes.flush();
    append_size(cells_ * 8);
    Buffer<std::int64_t> offsets(file_);
    for (std::size_t c = 0; c < cells_; ++c) offsets.push(static_cast<std::int64_t>((c + 1) * nodes_));
    offsets.flush();
    append_size(cells_);
    Buffer<std::uint8_t> types(file_);
    for (std::size_t c = 0; c < cells_; ++c) types.push(static_cast<std::uint8_t>(grid_.cell->vtk));
    types.flush();
  }

  static constexpr std::size_t entries_at_a_time = 4096;

  const std::string& path_;
  const Grid& grid_;
  std::size_t nodes_, dim_, points_, cells_;
  AtomicFile file_;
  std::uint64_t offset_ = 0;
};

}  // namespace

void write_vtu(const std::string& path, const Grid& grid) { VtuWriter(path, grid).write(); }

void write_pvtu(const std::string& path, const Grid& like, std::span<const std::string> pieces) {
  std::string text = header("PUnstructuredGrid") + "<PUnstructuredGrid GhostLevel=\"0\">\n";
  const auto fields = [&](const std::string& element, const std::vector<Field>& list) {
    text += "<" + element + ">\n";
    for (const Field& field : list) text += "<PDataArray " + array_attributes(like, field) + "/>\n";
    text += "</" + element + ">\n";
  };
  fields("PPointData", like.point_fields);
  fields("PCellData", like.cell_fields);
  text += "<PPoints>\n<PDataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"/>\n</PPoints>\n";
  for (const std::string& piece : pieces) text += "<Piece Source=\"" + xml_escape(piece) + "\"/>\n";
  write_file(path, text + "</PUnstructuredGrid>\n</VTKFile>\n");
}

void write_pvd(const std::string& path, std::span<const PvdPart> parts) {
  std::string text = header("Collection") + "<Collection>\n";
  for (const PvdPart& part : parts) {
    std::ostringstream time;
    time.precision(17);
    time << part.time;
    text += "<DataSet timestep=\"" + time.str() + "\" part=\"" + std::to_string(part.part) + "\" name=\"" +
            xml_escape(part.name) + "\" file=\"" + xml_escape(part.file) + "\"/>\n";
  }
  write_file(path, text + "</Collection>\n</VTKFile>\n");
}

}  // namespace kacanov
