// SPDX-License-Identifier: BSD-3-Clause
#include "part_files.hpp"

#include "case_identity.hpp"
#include "error.hpp"
#include "hashed_file.hpp"
#include "output_folder.hpp"
#include "part_fields.hpp"

namespace kacanov {

template <class G, class Stream>
  requires std::is_same_v<std::remove_const_t<G>, Group>
void exchange_fields(G& group, const Stream& stream) {
  stream(group.name);
  stream(group.dimension);
  stream(group.members);
}

/// What keep_boundary leaves.
template <class P, class Stream>
  requires std::is_same_v<std::remove_const_t<P>, Problem>
void exchange_fields(P& problem, const Stream& stream) {
  auto& mesh = problem.mesh;
  stream(mesh.type);
  stream(mesh.coordinates);
  stream(mesh.elements);
  stream(mesh.node_tags);
  stream(mesh.element_tags);
  stream(mesh.facets);
  stream(mesh.facet_element);
  stream(mesh.groups);
  stream(problem.contact);
  stream(problem.warnings);
}

namespace {

using nlohmann::json;

constexpr std::string_view part_magic = "kacanov part 1\n", boundary_magic = "kacanov boundary 1\n";
/// The sections of a case that parts are made of.
constexpr const char* sections[] = {"mesh", "material", "boundary", "contact", "probe"};

std::filesystem::path part_file(const std::filesystem::path& folder, int rank) {
  return folder / ("part_" + std::to_string(rank) + ".kacanov");
}

std::filesystem::path boundary_file(const std::filesystem::path& folder) { return folder / "boundary.kacanov"; }

/// Size of the mesh file: -1 where there is none, as on a machine that has the parts only.
std::int64_t mesh_bytes(const Case& input) {
  std::error_code error;
  const auto bytes = input.mesh.file ? std::filesystem::file_size(*input.mesh.file, error) : 0;
  return error ? -1 : static_cast<std::int64_t>(bytes);
}

HashedReader open_file(const std::filesystem::path& file, std::string_view magic, const std::string& kind) {
  if (!std::filesystem::exists(file))
    throw InputError("--parts: there is no file " + file.string() + ", which kacanov partition writes");
  return HashedReader(file.string(), magic, kind);
}

HashedReader open_part(const std::filesystem::path& folder, int rank) { return open_file(part_file(folder, rank), part_magic, "part"); }

HashedReader open_boundary(const std::filesystem::path& folder) {
  return open_file(boundary_file(folder), boundary_magic, "boundary");
}

/// Throws InputError where the parts were made of another case. The mesh file itself is not read: its size speaks for it.
void check_case(const json& header, const Case& input, const std::string& file) {
  const json& there = header.at("case");
  std::string text = describe_differences(there, input.document, differing_sections(there, input.document, sections));
  const std::int64_t bytes_there = header.at("mesh_bytes"), bytes = mesh_bytes(input);
  if (text.empty() && bytes >= 0 && bytes != bytes_there) {
    text = "mesh differs (" + *input.mesh.file + ": " + std::to_string(bytes_there) + " bytes there, " + std::to_string(bytes) +
           " here)";
  }
  if (!text.empty()) throw InputError("--parts: " + file + " belongs to another case: " + text);
}

/// Throws InputError unless this is the header of the part of a rank, for this case and as many ranks.
void check_part(const json& header, const Case& input, const MpiSession& mpi, const std::string& file) {
  check_case(header, input, file);
  const int parts = header.at("parts"), part = header.at("part");
  if (parts != mpi.ranks()) {
    throw InputError("--parts: " + file + " is one of " + std::to_string(parts) + " parts, expected as many ranks, but " +
                     std::to_string(mpi.ranks()) + " were started");
  }
  if (part != mpi.rank())
    throw InputError("--parts: " + file + ": expected part " + std::to_string(mpi.rank()) + ", got part " + std::to_string(part));
}

/// What all files of one split have in common.
std::uint64_t split_identity(json header) {
  header.erase("part");
  const std::string text = header.dump();
  return hash_bytes(text.data(), text.size());
}

}  // namespace

void write_parts(const std::filesystem::path& folder, const Case& input, Problem problem, int parts) {
  prepare_folder(folder);
  std::filesystem::remove(boundary_file(folder));
  for (int rank = parts; std::filesystem::remove(part_file(folder, rank)); ++rank) {
  }
  const json header{{"parts", parts},
                    {"case", case_sections(input.document, sections)},
                    {"mesh_bytes", mesh_bytes(input)},
                    {"problem", fingerprint_json(fingerprint(problem))}};
  split(problem, parts, [&](int rank, Part&& part) {
    json own = header;
    own["part"] = rank;
    HashedWriter file(part_file(folder, rank).string(), part_magic, own);
    FieldWriter{file}(part);
    file.commit();
  });
  const std::vector<std::int32_t> boundary_nodes = keep_boundary(problem);
  HashedWriter file(boundary_file(folder).string(), boundary_magic, header);
  const FieldWriter write{file};
  write(problem);
  write(boundary_nodes);
  file.commit();
}

int count_parts(const std::filesystem::path& folder, const Case& input) {
  const HashedReader reader = open_boundary(folder);
  check_case(reader.header(), input, boundary_file(folder).string());
  return reader.header().at("parts");
}

LoadedCase load_parts(const std::filesystem::path& folder, const Case& input, const MpiSession& mpi) {
  const double start = MPI_Wtime();
  LoadedCase loaded;
  std::uint64_t identity = 0, first_identity = 0;
  together(mpi, [&] {
    check_supported(input.model.solver);
    if (mpi.first()) {
      HashedReader reader = open_boundary(folder);
      check_case(reader.header(), input, boundary_file(folder).string());
      const FieldReader read{reader};
      read(loaded.problem.emplace());
      read(loaded.boundary_nodes);
      reader.finish();
      loaded.print = parse_fingerprint(reader.header().at("problem"));
      first_identity = split_identity(reader.header());
    }
    HashedReader reader = open_part(folder, mpi.rank());
    check_part(reader.header(), input, mpi, part_file(folder, mpi.rank()).string());
    FieldReader{reader}(loaded.part);
    reader.finish();
    identity = split_identity(reader.header());
    if (mpi.first()) print_warnings(input, *loaded.problem);
  });
  MPI_Bcast(&first_identity, 1, MPI_UINT64_T, 0, mpi.comm());
  together(mpi, [&] {
    if (identity != first_identity) {
      throw InputError("--parts: " + part_file(folder, mpi.rank()).string() + " belongs to another split than " +
                       boundary_file(folder).string() + "; write all of them again");
    }
  });
  join(loaded.part, mpi.comm());
  loaded.read_seconds = MPI_Wtime() - start;
  return loaded;
}

}  // namespace kacanov
