// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelCourse_h
#define volumicLabelCourse_h

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <numeric>
#include <string>
#include <vector>

namespace volumic
{
/** What a rank has done of the items that are due. */
struct LabelProgress
{
  double Done = 0.0; ///< of their sizes
  std::int64_t Finished = 0;
  std::int64_t UnderWay = -1; ///< that which was begun last of those under way; -1: none

  void Add(const LabelProgress& other)
  {
    this->Done += other.Done;
    this->Finished += other.Finished;
    this->UnderWay = this->UnderWay >= 0 ? this->UnderWay : other.UnderWay;
  }
};

/** What this rank does of all items, and which of them are under way. */
class LabelCourse
{
public:
  LabelCourse(const std::vector<double>& sizes, const std::vector<std::string>& names)
    : Sizes(sizes), Names(names), Shares(sizes.size())
    , Whole(std::accumulate(sizes.begin(), sizes.end(), 0.0))
  {
  }

  /** Some of the items are to be done, for the first time or anew, and some of these here. */
  void Expect(const std::string& title, const std::vector<std::uint8_t>& isDue,
    const std::vector<std::size_t>& own)
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->Title = title;
    this->Finished = 0;
    this->Expected = std::count(isDue.begin(), isDue.end(), 1);
    this->Own = own;
    this->Before = 0.0;
    for (std::size_t i = 0; i < isDue.size(); ++i)
    {
      this->Shares[i] = 0.f;
      this->Before += isDue[i] != 0 ? 0.0 : this->Sizes[i];
    }
  }

  // The next three on any thread.

  void Begin(std::size_t item)
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->UnderWay.push_back(item);
  }
  void Tell(std::size_t item, double share)
  {
    // A revision of the surface sets back what its run tells.
    this->Shares[item] = std::max(this->Shares[item].load(), static_cast<float>(share));
  }
  void End(std::size_t item)
  {
    this->Shares[item] = 1.f;
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->UnderWay.erase(std::find(this->UnderWay.begin(), this->UnderWay.end(), item));
    ++this->Finished;
  }

  LabelProgress Here() const
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    LabelProgress here;
    for (const std::size_t item : this->Own)
    {
      here.Done += this->Sizes[item] * this->Shares[item];
    }
    here.Finished = this->Finished;
    here.UnderWay = this->UnderWay.empty() ? -1 : static_cast<std::int64_t>(this->UnderWay.back());
    return here;
  }

  /** Of all items, where the ranks have done this here. */
  double Share(const LabelProgress& all) const { return (this->Before + all.Done) / this->Whole; }

  /** `12 of 39, liver`: how many are finished, and one that is under way. */
  std::string Text(const LabelProgress& all) const
  {
    const std::string text =
      this->Title + std::to_string(all.Finished) + " of " + std::to_string(this->Expected);
    const auto item = static_cast<std::size_t>(all.UnderWay); // Neighbours have no names.
    return item < this->Names.size() ? text + ", " + this->Names[item] : text;
  }

  std::atomic<bool> IsStopped{ false };

private:
  const std::vector<double>& Sizes;
  const std::vector<std::string>& Names;
  std::vector<std::atomic<float>> Shares;
  double Whole;
  double Before = 0.0; ///< of what is not due
  std::string Title;
  std::ptrdiff_t Expected = 0;
  std::vector<std::size_t> Own;
  mutable std::mutex Mutex; ///< of what follows
  std::vector<std::size_t> UnderWay; ///< in the order in which they were begun
  std::int64_t Finished = 0;
};
}

#endif
