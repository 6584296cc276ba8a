// SPDX-License-Identifier: BSD-3-Clause
// Writes one VTK file of a grid that is distributed over the ranks.
#include "program/shared_grid.hpp"

#include <array>
#include <deque>
#include <exception>
#include <optional>

#include "partition/part_fields.hpp"

namespace kacanov {
namespace {

GridPlace place_of(const Grid& share, const MpiSession& mpi) {
  const std::array<std::uint64_t, 2> here{share.points.size() / static_cast<std::size_t>(share.dim),
                                          share.cells.size() / static_cast<std::size_t>(share.cell->nodes)};
  std::array<std::uint64_t, 2> all{}, before{};
  mpi.expect_all_here();
  MPI_Allreduce(here.data(), all.data(), 2, MPI_UINT64_T, MPI_SUM, mpi.comm());
  MPI_Exscan(here.data(), before.data(), 2, MPI_UINT64_T, MPI_SUM, mpi.comm());
  if (mpi.first()) before = {};  // MPI_Exscan leaves it undefined on the first rank
  return {all[0], all[1], before[0], before[1]};
}

enum class Kind : std::uint64_t { loose, packed, end, failed };

/// Header of a message: its kind, and the sizes of bytes and lengths.
struct Front {
  Kind kind = Kind::end;
  std::uint64_t bytes = 0, lengths = 0;
};

/// Sends blocks to the first rank without waiting while that compresses its own; at the end of an array it
/// waits until all are received. MPI may transfer data only while both ranks are inside it: when ranks went
/// on to the next array, the first one waited for their data, a third of the time of a file.
class Sender : public BlockSink {
 public:
  explicit Sender(MPI_Comm comm) : comm_(comm) {}
  ~Sender() override { wait_for_all(); }
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;

  void loose(std::span<const unsigned char> bytes) override { send(Kind::loose, bytes, {}); }
  void packed(std::span<const unsigned char> bytes, std::span<const std::uint64_t> lengths) override {
    send(Kind::packed, bytes, lengths);
  }
  void send(Kind kind, std::span<const unsigned char> bytes = {},
            std::span<const std::uint64_t> lengths = {}) {
    waiting_.push_back({{kind, bytes.size(), lengths.size()},
                        {lengths.begin(), lengths.end()},
                        {bytes.begin(), bytes.end()},
                        {MPI_REQUEST_NULL, MPI_REQUEST_NULL, MPI_REQUEST_NULL}});
    Message& message = waiting_.back();
    const auto start = [&](const void* data, std::size_t size, MPI_Request& request) {
      MPI_Isend(data, static_cast<int>(size), MPI_BYTE, 0, 1, comm_, &request);
    };
    start(&message.front, sizeof message.front, message.requests[0]);
    if (!lengths.empty()) start(message.lengths.data(), lengths.size_bytes(), message.requests[1]);
    if (!bytes.empty()) start(message.bytes.data(), bytes.size(), message.requests[2]);
    if (kind == Kind::end) wait_for_all();
  }
  /// Needs no memory, which may be what has run out.
  void give_up() {
    wait_for_all();
    const Front front{Kind::failed, 0, 0};
    send_bytes(&front, sizeof front, 0, comm_);
  }

 private:
  struct Message {
    Front front;
    std::vector<std::uint64_t> lengths;
    std::vector<unsigned char> bytes;
    std::array<MPI_Request, 3> requests;
  };

  void wait_for_all() {
    for (Message& message : waiting_) MPI_Waitall(3, message.requests.data(), MPI_STATUSES_IGNORE);
    waiting_.clear();
  }

  MPI_Comm comm_;
  std::deque<Message> waiting_;  ///< messages of one array
};

/// Sends all arrays; after an error, reports it and sends nothing more.
void send_share(const VtuShare& share, const MpiSession& mpi) {
  Sender sender(mpi.comm());
  try {
    for (std::size_t array = share.arrays(); array-- > 0;) {
      share.pack(array, sender);
      sender.send(Kind::end);
    }
  } catch (...) {
    sender.give_up();
    throw;
  }
}

/// Writes on the first rank. Receives all messages even after an error, so that no sender blocks.
class Collector {
 public:
  Collector(const std::string& path, const VtuShare& share, const MpiSession& mpi)
      : share_(share), comm_(mpi.comm()), failed_(static_cast<std::size_t>(mpi.ranks()), false) {
    bytes_.resize(BlockPacker::most);
    lengths_.resize(BlockPacker::most / 16);  // a whole compressed block is much longer than 16 bytes
    attempt([&] { file_.emplace(path, share); });
  }

  void write() {
    const auto ranks = static_cast<int>(failed_.size());
    bool whole = true;
    for (std::size_t array = share_.arrays(); array-- > 0;) {
      attempt([&] { file_->begin(array); });
      attempt([&] { share_.pack(array, *file_); });
      for (int rank = 1; rank < ranks; ++rank) {
        const auto r = static_cast<std::size_t>(rank);
        if (!failed_[r]) failed_[r] = !take_share(rank);
        whole = whole && !failed_[r];
      }
      attempt([&] { file_->end(); });
    }
    if (whole) attempt([&] { file_->commit(); });
    file_.reset();
    if (error_) std::rethrow_exception(error_);
  }

 private:
  template <typename Work>
  void attempt(const Work& work) {
    if (error_) return;
    try {
      work();
    } catch (...) {
      error_ = std::current_exception();
    }
  }

  /// Receives a rank's share of an array; false: the rank has failed.
  bool take_share(int rank) {
    while (true) {
      Front front;
      receive_bytes(&front, sizeof front, rank, comm_);
      if (front.kind == Kind::end) return true;
      if (front.kind == Kind::failed) return false;
      const auto lengths = std::span(lengths_).first(front.lengths);
      const auto bytes = std::span(bytes_).first(front.bytes);
      receive_bytes(lengths.data(), lengths.size_bytes(), rank, comm_);
      receive_bytes(bytes.data(), bytes.size(), rank, comm_);
      attempt([&] {
        if (front.kind == Kind::loose)
          file_->loose(bytes);
        else
          file_->packed(bytes, lengths);
      });
    }
  }

  const VtuShare& share_;
  MPI_Comm comm_;
  std::optional<VtuFileWriter> file_;
  std::vector<bool> failed_;  ///< ranks that send nothing more
  std::vector<unsigned char> bytes_;
  std::vector<std::uint64_t> lengths_;
  std::exception_ptr error_;
};

}  // namespace

void write_shared_vtu(const std::string& path, const Grid& share, const MpiSession& mpi) {
  const GridPlace place = place_of(share, mpi);
  std::optional<VtuShare> arrays;
  std::optional<Collector> collector;
  together(mpi, [&] {
    arrays.emplace(path, share, place);
    if (mpi.first()) collector.emplace(path, *arrays, mpi);
  });
  std::exception_ptr error;
  try {
    if (mpi.first())
      collector->write();
    else
      send_share(*arrays, mpi);
  } catch (...) {
    error = std::current_exception();
  }
  together(mpi, [&] {
    if (error) std::rethrow_exception(error);
  });
}

}  // namespace kacanov
