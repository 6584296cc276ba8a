// SPDX-License-Identifier: BSD-3-Clause
// MPI implementation of the transport between ranks.
#include <kacanov/part.hpp>

#include <numeric>
#include <vector>

namespace kacanov {
namespace {

class MpiMessages final : public Messages {
 public:
  explicit MpiMessages(MPI_Comm comm) : comm_(comm) {}
  void receive(void* to, std::size_t count, std::size_t width, int rank) override {
    MPI_Irecv(to, static_cast<int>(count), type_of(width), rank, 0, comm_, &requests_.emplace_back());
  }
  void send(const void* from, std::size_t count, std::size_t width, int rank) override {
    MPI_Isend(from, static_cast<int>(count), type_of(width), rank, 0, comm_, &requests_.emplace_back());
  }
  void wait() override {
    MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
    requests_.clear();
  }

 private:
  static MPI_Datatype type_of(std::size_t width) { return width == 4 ? MPI_INT32_T : MPI_INT64_T; }
  MPI_Comm comm_;
  std::vector<MPI_Request> requests_;
};

/// MPI datatype of an entry with this many bytes.
class Entries {
 public:
  explicit Entries(std::size_t width) {
    MPI_Type_contiguous(static_cast<int>(width), MPI_BYTE, &type_);
    MPI_Type_commit(&type_);
  }
  ~Entries() { MPI_Type_free(&type_); }
  Entries(const Entries&) = delete;
  Entries& operator=(const Entries&) = delete;
  MPI_Datatype type() const noexcept { return type_; }

 private:
  MPI_Datatype type_ = MPI_DATATYPE_NULL;
};

std::vector<int> starts(std::span<const int> count) {
  std::vector<int> at(count.size());
  std::exclusive_scan(count.begin(), count.end(), at.begin(), 0);
  return at;
}

class MpiTransport final : public Transport {
 public:
  explicit MpiTransport(MPI_Comm of) : comm(of) {}
  void sum(std::span<double> values) const override {
    MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_SUM, comm);
  }
  void sum(std::span<std::int64_t> values) const override {
    MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_INT64_T, MPI_SUM, comm);
  }
  void max(std::span<double> values) const override {
    MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_MAX, comm);
  }
  std::int64_t sum_below(std::int64_t value) const override {
    int rank = 0;
    MPI_Comm_rank(comm, &rank);
    std::int64_t below = 0;
    MPI_Exscan(&value, &below, 1, MPI_INT64_T, MPI_SUM, comm);
    return rank == 0 ? 0 : below;
  }
  std::vector<std::int64_t> all(std::int64_t value) const override {
    std::vector<std::int64_t> values(size());
    MPI_Allgather(&value, 1, MPI_INT64_T, values.data(), 1, MPI_INT64_T, comm);
    return values;
  }
  std::vector<int> exchange(std::span<const int> to) const override {
    std::vector<int> from(to.size());
    MPI_Alltoall(to.data(), 1, MPI_INT, from.data(), 1, MPI_INT, comm);
    return from;
  }
  void exchange(const void* from, const Pieces& out, void* to, const Pieces& in) const override {
    const Entries entry(out.width);
    const auto out_at = starts(out.count), in_at = starts(in.count);
    MPI_Alltoallv(from, out.count.data(), out_at.data(), entry.type(), to, in.count.data(), in_at.data(),
                  entry.type(), comm);
  }
  void gather(const void* from, void* to, const Pieces& in) const override {
    const Entries entry(in.width);
    const auto in_at = starts(in.count);
    int rank = 0;
    MPI_Comm_rank(comm, &rank);
    MPI_Allgatherv(from, in.count[rank], entry.type(), to, in.count.data(), in_at.data(), entry.type(), comm);
  }
  std::unique_ptr<Messages> messages() const override { return std::make_unique<MpiMessages>(comm); }

  const MPI_Comm comm;

 private:
  int size() const {
    int ranks = 1;
    MPI_Comm_size(comm, &ranks);
    return ranks;
  }
};

}  // namespace

Communicator mpi_communicator(MPI_Comm comm) {
  Communicator made;
  MPI_Comm_rank(comm, &made.rank);
  MPI_Comm_size(comm, &made.ranks);
  made.transport = std::make_shared<MpiTransport>(comm);
  return made;
}

MPI_Comm mpi_of(const Communicator& communicator) {
  const auto* mpi = dynamic_cast<const MpiTransport*>(communicator.transport.get());
  return mpi == nullptr ? MPI_COMM_SELF : mpi->comm;
}

}  // namespace kacanov
