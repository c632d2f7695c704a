#include "core/map/list_parts.h"

#include <algorithm>
#include <numeric>
#include <string>

#include "core/map/descriptor_tables.h"

namespace lodemark {
namespace {

std::vector<std::uint32_t> ImagesOf(std::span<const DescriptorOrigin> origins) {
  std::vector<std::uint32_t> images;
  images.reserve(origins.size());
  for (const DescriptorOrigin& origin : origins) images.push_back(origin.image_id);
  std::sort(images.begin(), images.end());
  images.erase(std::unique(images.begin(), images.end()), images.end());
  return images;
}

Result<std::vector<std::int64_t>> Keys(const MapFile& file, SqliteStatement& rows) {
  std::vector<std::int64_t> keys;
  while (rows.Step()) {
    const std::optional<std::int64_t> key = rows.Integer(0);
    if (!key || *key < 0) {
      return file.connection->MakeError(ErrorCode::kBadData, "a part's key is out of range");
    }
    keys.push_back(*key);
  }
  if (Status status = rows.status(); !status) return status.error();
  return keys;
}

}  // namespace

ListPartReader::ListPartReader(const MapFile* file)
    : file_(file),
      rows_(file->connection.get(),
            "SELECT list_part, index_id, descriptors FROM descriptor_lists "
            "WHERE list_part BETWEEN ?1 AND ?2 ORDER BY list_part") {}

Status ListPartReader::ForEach(std::int64_t first_key, std::int64_t last_key,
                               const Visitor& visit) {
  rows_.Bind(1, first_key);
  rows_.Bind(2, last_key);
  std::int64_t previous = -1;
  while (rows_.Step()) {
    const std::int64_t key = rows_.Integer(0).value_or(-1);
    const auto bad = [&](const std::string& sentence) {
      return file_->connection->MakeError(
          ErrorCode::kBadData, "descriptor_lists: list " + std::to_string(ListOfKey(key)) +
                                   " part " + std::to_string(PartOfKey(key)) + ": " + sentence);
    };
    if (key <= previous || key < first_key || key > last_key ||
        ListOfKey(key) >= file_->quantizer->list_count()) {
      return bad("is out of place; get the map again from where it was made");
    }
    previous = key;
    if (rows_.Integer(1) != file_->map.index_id) return bad("belongs to another index");
    const std::optional<std::span<const std::uint8_t>> bytes = rows_.Blob(2);
    if (!bytes) return bad("is not a blob");
    const Result<DescriptorListView> view =
        DescriptorListView::Parse(file_->map.info.descriptor_kind, *bytes);
    if (!view) return bad(view.error().message);
    visit(key, *view);
  }
  Status status = rows_.status();
  rows_.Reset();
  return status;
}

void DescriptorBatch::Append(const DescriptorOrigin& origin,
                             std::span<const std::uint8_t> descriptor) {
  origins.push_back(origin);
  descriptors.insert(descriptors.end(), descriptor.begin(), descriptor.end());
}

void DescriptorBatch::Clear() {
  origins.clear();
  descriptors.clear();
}

void DescriptorBatch::RemoveIf(std::size_t bytes_each,
                               const std::function<bool(const DescriptorOrigin&)>& goes) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < origins.size(); ++i) {
    if (goes(origins[i])) continue;
    if (kept != i) {
      origins[kept] = origins[i];
      std::copy_n(descriptors.data() + i * bytes_each, bytes_each,
                  descriptors.data() + kept * bytes_each);
    }
    ++kept;
  }
  origins.resize(kept);
  descriptors.resize(kept * bytes_each);
}

ListPartWriter::ListPartWriter(const MapFile* file)
    : file_(file),
      bytes_each_(DescriptorBytes(file->map.info.descriptor_kind)),
      reader_(file),
      last_part_(file->connection.get(),
                 "SELECT list_part FROM descriptor_lists WHERE list_part BETWEEN ?1 AND ?2 "
                 "ORDER BY list_part DESC LIMIT 1"),
      put_part_(file->connection.get(),
                "INSERT OR REPLACE INTO descriptor_lists VALUES (?1, ?2, ?3)"),
      delete_part_(file->connection.get(), "DELETE FROM descriptor_lists WHERE list_part = ?1"),
      put_image_(file->connection.get(), "INSERT OR REPLACE INTO image_lists VALUES (?1, ?2)"),
      delete_image_(file->connection.get(),
                    "DELETE FROM image_lists WHERE image_id = ?1 AND list_part = ?2") {}

std::size_t ListPartWriter::MostInPart() const {
  const std::size_t most_bytes = kLargestListPart_bytes - kListHeaderBytes;
  const bool coded = file_->quantizer->tables().coded;
  std::size_t count = most_bytes / (kOriginBytes + bytes_each_);
  while (coded && count * (kOriginBytes + bytes_each_) + CodeBytes(count) > most_bytes) --count;
  return count;
}

Status ListPartWriter::Insert(const DescriptorBatch& batch) {
  const std::vector<int> lists = file_->quantizer->ListsOf(batch.descriptors);
  std::vector<std::uint32_t> order(lists.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return lists[a] < lists[b]; });
  for (std::size_t begin = 0; begin < order.size();) {
    const int list = lists[order[begin]];
    std::size_t end = begin;
    while (end < order.size() && lists[order[end]] == list) ++end;
    const Status status = InsertInList(list, batch, std::span(order).subspan(begin, end - begin));
    if (!status) return status;
    begin = end;
  }
  return {};
}

Status ListPartWriter::InsertInList(int list, const DescriptorBatch& batch,
                                    std::span<const std::uint32_t> members) {
  last_part_.Bind(1, ListPartKey(list, 0));
  last_part_.Bind(2, ListPartKey(list + std::int64_t{1}, 0) - 1);
  std::int64_t key = ListPartKey(list, 0);
  DescriptorBatch part;
  if (last_part_.Step()) {
    key = last_part_.Integer(0).value_or(key);
    Result<DescriptorBatch> last = Read(key);
    if (!last) return last.error();
    part = *std::move(last);
  }
  if (Status status = last_part_.status(); !status) return status;
  last_part_.Reset();

  const std::size_t most = MostInPart();
  std::vector<DescriptorOrigin> before = part.origins;
  if (part.origins.size() >= most) {
    ++key;
    part.Clear();
    before.clear();
  }
  for (std::size_t i = 0; i < members.size(); ++i) {
    part.Append(batch.origins[members[i]],
                std::span(batch.descriptors).subspan(members[i] * bytes_each_, bytes_each_));
    if (part.origins.size() < most && i + 1 < members.size()) continue;
    if (ListOfKey(key) != list) {
      return file_->connection->MakeError(ErrorCode::kBadData,
                                          "descriptor_lists: is damaged: a list's parts are full");
    }
    if (Status status = Replace(key, before, part); !status) return status;
    ++key;
    part.Clear();
    before.clear();
  }
  return {};
}

Result<DescriptorBatch> ListPartWriter::Read(std::int64_t key) {
  DescriptorBatch batch;
  const Status status =
      reader_.ForEach(key, key, [&](std::int64_t, const DescriptorListView& view) {
        for (std::size_t i = 0; i < view.size(); ++i) {
          batch.Append(view.origin(i), {view.descriptor(i), bytes_each_});
        }
      });
  if (!status) return status.error();
  return batch;
}

Status ListPartWriter::Replace(std::int64_t key, std::span<const DescriptorOrigin> before,
                               const DescriptorBatch& after) {
  const std::vector<std::uint32_t> old_images = ImagesOf(before);
  const std::vector<std::uint32_t> new_images = ImagesOf(after.origins);
  const auto note = [&](SqliteStatement& statement, const std::vector<std::uint32_t>& images,
                        const std::vector<std::uint32_t>& but_not) -> Status {
    for (const std::uint32_t image : images) {
      if (std::binary_search(but_not.begin(), but_not.end(), image)) continue;
      statement.Bind(1, static_cast<std::int64_t>(image));
      statement.Bind(2, key);
      if (Status status = statement.Run(); !status) return status;
    }
    return {};
  };
  if (Status status = note(delete_image_, old_images, new_images); !status) return status;
  if (Status status = note(put_image_, new_images, old_images); !status) return status;
  if (after.origins.empty()) {
    delete_part_.Bind(1, key);
    return delete_part_.Run();
  }
  const std::vector<std::uint8_t> packed = file_->quantizer->PackList(
      static_cast<int>(ListOfKey(key)), after.origins, after.descriptors);
  put_part_.Bind(1, key);
  put_part_.Bind(2, file_->map.index_id);
  put_part_.Bind(3, std::span<const std::uint8_t>(packed));
  return put_part_.Run();
}

Status ListPartWriter::TakeAll(DescriptorBatch* batch) {
  const Status status =
      reader_.ForEach(0, INT64_MAX, [&](std::int64_t, const DescriptorListView& view) {
        for (std::size_t i = 0; i < view.size(); ++i) {
          batch->Append(view.origin(i), {view.descriptor(i), bytes_each_});
        }
      });
  if (!status) return status;
  return file_->connection->Execute("DELETE FROM descriptor_lists; DELETE FROM image_lists");
}

Result<std::vector<std::int64_t>> ListPartWriter::AllParts() {
  SqliteStatement rows(file_->connection.get(),
                       "SELECT list_part FROM descriptor_lists ORDER BY list_part");
  return Keys(*file_, rows);
}

Result<std::vector<std::int64_t>> ListPartWriter::PartsOfImage(std::uint32_t image_id) {
  SqliteStatement rows(file_->connection.get(),
                       "SELECT list_part FROM image_lists WHERE image_id = ?1 ORDER BY list_part");
  rows.Bind(1, static_cast<std::int64_t>(image_id));
  return Keys(*file_, rows);
}

Status ListPartWriter::Remove(std::int64_t key,
                              const std::function<bool(const DescriptorOrigin&)>& goes,
                              std::map<std::uint32_t, std::int64_t>* gone_of_landmark) {
  Result<DescriptorBatch> part = Read(key);
  if (!part) return part.error();
  const std::vector<DescriptorOrigin> before = part->origins;
  for (const DescriptorOrigin& origin : before) {
    if (goes(origin)) ++(*gone_of_landmark)[origin.landmark_id];
  }
  part->RemoveIf(bytes_each_, goes);
  if (part->origins.size() == before.size()) return {};
  return Replace(key, before, *part);
}

}  // namespace lodemark
