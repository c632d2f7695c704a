// The lists of descriptors as the feature map's file holds them: in parts that fill a page each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <vector>

#include "core/map/descriptor_index.h"
#include "core/map/map_file.h"
#include "core/map/sqlite_statement.h"

namespace lodemark {

// Reads parts within a transaction. Does not outlive the file's connection.
class ListPartReader {
 public:
  explicit ListPartReader(const MapFile* file);

  // All parts whose keys lie in the range, ascending. Ids and places in a view are unchecked.
  using Visitor = std::function<void(std::int64_t key, const DescriptorListView& view)>;
  Status ForEach(std::int64_t first_key, std::int64_t last_key, const Visitor& visit);

  // Whether the file could be asked at all.
  Status status() const { return rows_.status(); }

  // Lets the file go after a visit that failed.
  void Reset() { rows_.Reset(); }

 private:
  const MapFile* file_;
  SqliteStatement rows_;
};

// Descriptors one after another, origins[i] belonging to the i-th.
struct DescriptorBatch {
  std::vector<DescriptorOrigin> origins;
  std::vector<std::uint8_t> descriptors;

  void Append(const DescriptorOrigin& origin, std::span<const std::uint8_t> descriptor);
  void Clear();

  // Removes those whose origins are to go; bytes_each is of one descriptor.
  void RemoveIf(std::size_t bytes_each, const std::function<bool(const DescriptorOrigin&)>& goes);
};

// Changes parts within a transaction, and the note of which image has descriptors in which part.
class ListPartWriter {
 public:
  explicit ListPartWriter(const MapFile* file);

  // Puts each descriptor at the end of its list by the file's quantiser.
  Status Insert(const DescriptorBatch& batch);

  // All there are, appended to the batch; the lists are empty after that.
  Status TakeAll(DescriptorBatch* batch);

  Result<std::vector<std::int64_t>> AllParts();
  Result<std::vector<std::int64_t>> PartsOfImage(std::uint32_t image_id);

  // Removes the descriptors of the part whose origins are to go, and adds up how many of each
  // landmark went. A part without such descriptors is not touched.
  Status Remove(std::int64_t key, const std::function<bool(const DescriptorOrigin&)>& goes,
                std::map<std::uint32_t, std::int64_t>* gone_of_landmark);

 private:
  // What the part holds from now on; before is what it held.
  Status Replace(std::int64_t key, std::span<const DescriptorOrigin> before,
                 const DescriptorBatch& after);
  Status InsertInList(int list, const DescriptorBatch& batch,
                      std::span<const std::uint32_t> members);
  Result<DescriptorBatch> Read(std::int64_t key);
  std::size_t MostInPart() const;

  const MapFile* file_;
  std::size_t bytes_each_;
  ListPartReader reader_;
  SqliteStatement last_part_;
  SqliteStatement put_part_;
  SqliteStatement delete_part_;
  SqliteStatement put_image_;
  SqliteStatement delete_image_;
};

}  // namespace lodemark
