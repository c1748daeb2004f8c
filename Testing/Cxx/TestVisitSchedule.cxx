// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/StandardThreads.h"
#include "Core/Common/VisitSchedule.h"
#include "ThreadTestTools.h"

#include <cstdlib>
#include <mutex>

using namespace volumic;

namespace
{
using Neighbours = std::vector<std::vector<int>>;

/** Cells of a box of this size: those that have a corner in common touch, but for some left out. */
Neighbours GridOf(const std::array<int, 3>& size, double share, std::mt19937& random)
{
  Neighbours neighbours(static_cast<std::size_t>(size[0] * size[1] * size[2]));
  std::uniform_real_distribution<double> chance(0., 1.);
  const auto placeOf = [&size](int item)
  {
    const int row = item / size[0];
    return std::array<int, 3>{ item % size[0], row % size[1], row / size[1] };
  };
  for (int a = 0; a < static_cast<int>(neighbours.size()); ++a)
  {
    for (int b = a + 1; b < static_cast<int>(neighbours.size()); ++b)
    {
      const std::array<int, 3> p = placeOf(a);
      const std::array<int, 3> q = placeOf(b);
      if (std::abs(p[0] - q[0]) <= 1 && std::abs(p[1] - q[1]) <= 1 && std::abs(p[2] - q[2]) <= 1 &&
        chance(random) < share)
      {
        neighbours[a].push_back(b);
        neighbours[b].push_back(a);
      }
    }
  }
  return neighbours;
}

std::vector<int> Shuffled(int n, std::mt19937& random)
{
  std::vector<int> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), random);
  return order;
}

VisitSchedule ScheduleOf(const std::vector<int>& order, const Neighbours& neighbours)
{
  return VisitSchedule(order, [&neighbours](int item) { return neighbours[item]; });
}

/** Items that do not touch. */
VisitSchedule Apart(int n)
{
  std::vector<int> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), 0);
  return VisitSchedule(order, [](int) { return std::vector<int>(); });
}

bool Always(std::size_t)
{
  return true;
}

/** Hears of visits from any thread, and whether each comes when it may. */
class Book
{
public:
  Book(const std::vector<int>& order, const Neighbours& neighbours)
    : Touching(neighbours)
    , Place(order.size())
    , Begun(order.size(), 0)
    , Ended(order.size(), 0)
  {
    for (std::size_t i = 0; i < order.size(); ++i)
    {
      this->Place[order[i]] = i;
    }
  }

  void Begin(int item, std::size_t place)
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->Check(place == this->Place[item], item, "another place was told");
    this->Check(++this->Begun[item] == 1, item, "visited again");
    for (const int other : this->Touching[item])
    {
      this->Check(this->Begun[other] == this->Ended[other], item, "at the same time");
      this->Check((this->Ended[other] == 1) == (this->Place[other] < place), item, "out of turn");
    }
    ++this->UnderWay;
    this->Most = std::max(this->Most, this->UnderWay);
  }
  void End(int item)
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    ++this->Ended[item];
    --this->UnderWay;
  }

  /** What was wrong first; empty: nothing. */
  std::string Wrong() const
  {
    const bool areAllVisited = std::all_of(
      this->Ended.begin(), this->Ended.end(), [](int visits) { return visits == 1; });
    return this->First.empty() && !areAllVisited ? "some were left out" : this->First;
  }
  int MostUnderWay() const { return this->Most; }

private:
  void Check(bool isRight, int item, const char* what)
  {
    if (!isRight && this->First.empty())
    {
      this->First = std::to_string(item) + ": " + what;
    }
  }

  const Neighbours& Touching;
  std::vector<std::size_t> Place;
  std::vector<int> Begun; ///< How often.
  std::vector<int> Ended;
  int UnderWay = 0;
  int Most = 0;
  std::string First;
  std::mutex Mutex;
};

/** For by a thread of its own, while the calling one waits. */
class OtherThread final : public Executor
{
public:
  void For(std::size_t n, std::size_t,
    const std::function<void(std::size_t, std::size_t)>& body) override
  {
    std::thread thread([&] { body(0, n); });
    thread.join();
    ++this->Calls;
  }

  int Calls = 0;
};

/** Makes the visits itself, from the last to the first. */
class OwnWay final : public Executor
{
public:
  void For(std::size_t n, std::size_t,
    const std::function<void(std::size_t, std::size_t)>& body) override
  {
    ++this->Calls;
    body(0, n);
  }
  bool MakeVisits(const VisitSchedule& schedule, const VisitBody& visit) override
  {
    const std::vector<int>& order = schedule.Order();
    for (std::size_t place = order.size(); place > 0; --place)
    {
      visit(order[place - 1], place - 1, *this);
    }
    return true;
  }

  int Calls = 0;
};
}

TEST(VisitSchedule, ToldOrderAndNeighboursAreThoseGiven)
{
  // A ring of five.
  const std::vector<int> order = { 3, 0, 4, 1, 2 };
  const VisitSchedule schedule(order,
    [](int item) { return std::vector<int>{ (item + 4) % 5, (item + 1) % 5 }; });
  EXPECT_EQ(schedule.Order(), order);
  const std::vector<int> earlier = { 0, 1, 2, 0, 2 };
  const Neighbours later = { { 4, 1 }, { 2 }, {}, { 2, 4 }, {} };
  for (int item = 0; item < 5; ++item)
  {
    EXPECT_EQ(schedule.NumberOfEarlier(item), earlier[item]) << item;
    EXPECT_EQ(schedule.LaterThan(item), later[item]) << item;
  }
}

TEST(VisitSchedule, VisitsEachOnceAndNeverWhatTouchesAtTheSameTime)
{
  std::mt19937 random(20);
  for (const int threads : { 1, 2, 5 })
  {
    StandardThreads executor(threads);
    for (int grid = 0; grid < 12; ++grid)
    {
      SCOPED_TRACE(std::to_string(threads) + " threads, grid " + std::to_string(grid));
      const auto length = [&random] { return 1 + static_cast<int>(random() % 6); };
      const std::array<int, 3> size = { length(), length(), length() };
      const int n = size[0] * size[1] * size[2];
      const Neighbours neighbours = GridOf(size, grid % 3 == 0 ? 1. : 0.6, random);
      const std::vector<int> order = Shuffled(n, random);
      std::vector<int> delays(static_cast<std::size_t>(n));
      std::generate(
        delays.begin(), delays.end(), [&random] { return static_cast<int>(random() % 200); });
      Book book(order, neighbours);
      const bool areAllDone = ScheduleOf(order, neighbours).Run(executor,
        [&](int item, std::size_t place, Executor&)
        {
          book.Begin(item, place);
          std::this_thread::sleep_for(std::chrono::microseconds(delays[item]));
          book.End(item);
        },
        Always);
      EXPECT_TRUE(areAllDone);
      EXPECT_EQ(book.Wrong(), "");
      EXPECT_LE(book.MostUnderWay(), threads);
    }
  }
}

TEST(VisitSchedule, MakesWhatOneThreadWouldMake)
{
  // What a visit makes depends on what those that it touches have made before.
  std::mt19937 random(4);
  const Neighbours neighbours = GridOf({ 7, 6, 5 }, 0.8, random);
  const std::vector<int> order = Shuffled(7 * 6 * 5, random);
  const VisitSchedule schedule = ScheduleOf(order, neighbours);
  const auto madeBy = [&](Executor& executor)
  {
    std::vector<std::uint64_t> values(order.size(), 1);
    schedule.Run(executor,
      [&](int item, std::size_t, Executor&)
      {
        for (const int other : neighbours[item])
        {
          values[item] = values[item] * 6364136223846793005ull + values[other];
        }
      },
      Always);
    return values;
  };
  SequentialExecutor thread;
  const std::vector<std::uint64_t> expected = madeBy(thread);
  for (const int threads : { 2, 3, 7 })
  {
    DelayedThreads executor(threads, 17u, 50, 4);
    for (int time = 0; time < 5; ++time)
    {
      EXPECT_EQ(madeBy(executor), expected) << threads << " threads";
    }
  }
}

TEST(VisitSchedule, KeepsTheOrderOnOneThread)
{
  std::mt19937 random(5);
  const Neighbours neighbours = GridOf({ 5, 4, 3 }, 0.7, random);
  const std::vector<int> order = Shuffled(60, random);
  const VisitSchedule schedule = ScheduleOf(order, neighbours);
  SequentialExecutor sequential;
  StandardThreads alone(1);
  OtherThread elsewhere;
  for (Executor* executor : std::initializer_list<Executor*>{ &sequential, &alone, &elsewhere })
  {
    std::vector<int> visited;
    EXPECT_TRUE(schedule.Run(*executor,
      [&visited](int item, std::size_t place, Executor&)
      {
        EXPECT_EQ(place, visited.size());
        visited.push_back(item);
      },
      Always));
    EXPECT_EQ(visited, order);
  }
}

TEST(VisitSchedule, WaitsForNoMoreThanWhatItTouches)
{
  // The first one ends when all have been visited but the one that touches it.
  constexpr int n = 40;
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  const VisitSchedule schedule(order,
    [](int item)
    { return item == 0 ? std::vector<int>{ 1 } : std::vector<int>(item == 1 ? 1 : 0, 0); });
  StandardThreads threads(2);
  std::atomic<int> others{ 0 };
  std::atomic<bool> isLate{ false };
  schedule.Run(threads,
    [&](int item, std::size_t, Executor&)
    {
      others += item > 1;
      const auto start = std::chrono::steady_clock::now();
      while (item == 0 && others < n - 2 && !isLate)
      {
        isLate = std::chrono::steady_clock::now() - start > std::chrono::seconds(20);
        std::this_thread::yield();
      }
    },
    Always);
  EXPECT_FALSE(isLate);
  EXPECT_EQ(others, n - 2);
}

TEST(VisitSchedule, AsksWhereOthersHaveMadeAllTheVisits)
{
  // The calling thread comes when all is done.
  struct LateCaller final : Executor
  {
    void For(std::size_t n, std::size_t,
      const std::function<void(std::size_t, std::size_t)>& body) override
    {
      std::thread other([&] { body(0, 1); });
      other.join();
      body(1, n);
    }
  } late;
  std::atomic<std::size_t> visits{ 0 };
  std::vector<std::size_t> asked; // More than once only where the machine is slow.
  const auto goOn = [&](std::size_t done)
  {
    EXPECT_EQ(done, visits);
    asked.push_back(done);
    return true;
  };
  EXPECT_TRUE(Apart(9).Run(late, [&](int, std::size_t, Executor&) { ++visits; }, goOn));
  ASSERT_FALSE(asked.empty());
  EXPECT_EQ(asked.back(), 9u);
}

TEST(VisitSchedule, AsksWhileOthersAreInLongVisits)
{
  // Another thread makes the one visit that there is, until the host has been asked twice.
  std::atomic<bool> hasBegun{ false };
  std::atomic<int> questions{ 0 };
  struct Waiting final : Executor
  {
    explicit Waiting(const std::atomic<bool>& hasBegun)
      : HasBegun(hasBegun)
    {
    }
    void For(std::size_t n, std::size_t,
      const std::function<void(std::size_t, std::size_t)>& body) override
    {
      std::thread other([&] { body(0, 1); });
      while (!this->HasBegun)
      {
        std::this_thread::yield();
      }
      body(1, n);
      other.join();
    }
    const std::atomic<bool>& HasBegun;
  } waiting(hasBegun);
  bool isLate = false;
  EXPECT_TRUE(Apart(1).Run(waiting,
    [&](int, std::size_t, Executor&)
    {
      hasBegun = true;
      const auto start = std::chrono::steady_clock::now();
      while (questions < 2 && !isLate)
      {
        isLate = std::chrono::steady_clock::now() - start > std::chrono::seconds(20);
        std::this_thread::yield();
      }
    },
    [&](std::size_t) { return ++questions > 0; }));
  EXPECT_FALSE(isLate);
}

TEST(VisitSchedule, HandsOnWhatAVisitThrows)
{
  // Each is before the next one, or none touches another: others wait, or are at work, or both.
  constexpr int n = 300;
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  const VisitSchedule chain(order,
    [](int item)
    {
      std::vector<int> beside;
      if (item > 0)
      {
        beside.push_back(item - 1);
      }
      if (item + 1 < n)
      {
        beside.push_back(item + 1);
      }
      return beside;
    });
  const VisitSchedule apart = Apart(n);
  SequentialExecutor sequential;
  StandardThreads three(3);
  StandardThreads five(5);
  for (const VisitSchedule* schedule : { &chain, &apart })
  {
    for (Executor* executor : std::initializer_list<Executor*>{ &sequential, &three, &five })
    {
      for (const int bad : { 0, 20 })
      {
        std::atomic<int> begun{ 0 };
        std::atomic<int> underWay{ 0 };
        try
        {
          schedule->Run(*executor,
            [&](int item, std::size_t, Executor&)
            {
              ++begun;
              ++underWay;
              std::this_thread::sleep_for(std::chrono::microseconds(500));
              --underWay;
              if (item == bad)
              {
                throw std::runtime_error("bad " + std::to_string(item));
              }
            },
            Always);
          FAIL() << "nothing is thrown";
        }
        catch (const std::runtime_error& error)
        {
          EXPECT_EQ(error.what(), "bad " + std::to_string(bad));
        }
        EXPECT_EQ(underWay, 0) << "it has left before others were finished";
        EXPECT_GT(begun, bad);
        EXPECT_LT(begun, n / 2) << "others went on";
      }
    }
  }
}

TEST(VisitSchedule, EndsWhereItIsTold)
{
  const VisitSchedule schedule = Apart(50);
  SequentialExecutor thread;
  for (const std::size_t last : { 1, 7, 49 })
  {
    std::size_t visits = 0;
    std::vector<std::size_t> asked;
    EXPECT_FALSE(schedule.Run(thread, [&visits](int, std::size_t, Executor&) { ++visits; },
      [&](std::size_t done)
      {
        asked.push_back(done);
        return done != last;
      }));
    EXPECT_EQ(visits, last);
    std::vector<std::size_t> each(last);
    std::iota(each.begin(), each.end(), std::size_t(1));
    EXPECT_EQ(asked, each) << "once after each visit, and not again";
  }
}

TEST(VisitSchedule, EndsSoonWhereItIsToldOnThreads)
{
  constexpr int n = 2000;
  const VisitSchedule schedule = Apart(n);
  StandardThreads standard(4);
  OtherThread other;
  for (Executor* executor : std::initializer_list<Executor*>{ &standard, &other })
  {
    std::atomic<int> visits{ 0 };
    std::atomic<int> underWay{ 0 };
    int asked = 0;
    EXPECT_FALSE(schedule.Run(*executor,
      [&](int, std::size_t, Executor&)
      {
        ++visits;
        ++underWay;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        --underWay;
      },
      [&asked](std::size_t) { return ++asked < 3; }));
    EXPECT_EQ(asked, 3) << "not asked again";
    EXPECT_EQ(underWay, 0);
    EXPECT_GE(visits, 3);
    EXPECT_LT(visits, n / 2);
  }
}

TEST(VisitSchedule, AsksOnTheCallingThreadAlone)
{
  constexpr int n = 300;
  const VisitSchedule schedule = Apart(n);
  StandardThreads standard(5);
  OtherThread other;
  const std::thread::id caller = std::this_thread::get_id();
  for (Executor* executor : std::initializer_list<Executor*>{ &standard, &other })
  {
    int asked = 0;
    int elsewhere = 0;
    std::size_t most = 0;
    EXPECT_TRUE(schedule.Run(*executor,
      [](int, std::size_t, Executor&) { std::this_thread::sleep_for(std::chrono::milliseconds(1)); },
      [&](std::size_t done)
      {
        ++asked;
        elsewhere += std::this_thread::get_id() != caller;
        EXPECT_GE(done, most);
        most = done;
        return true;
      }));
    EXPECT_GE(asked, 2) << "several times a second";
    EXPECT_EQ(elsewhere, 0);
    EXPECT_LE(most, static_cast<std::size_t>(n));
  }
  EXPECT_GT(other.Calls, 2) << "rounds, between which it is asked";
}

TEST(VisitSchedule, OfNoneOrOne)
{
  SequentialExecutor sequential;
  StandardThreads threads(3);
  for (Executor* executor : std::initializer_list<Executor*>{ &sequential, &threads })
  {
    int visits = 0;
    const auto visit = [&visits](int item, std::size_t place, Executor&)
    {
      ++visits;
      EXPECT_EQ(item, 0);
      EXPECT_EQ(place, 0u);
    };
    EXPECT_TRUE(Apart(0).Run(*executor, visit, Always));
    EXPECT_EQ(visits, 0);
    EXPECT_TRUE(Apart(1).Run(*executor, visit, Always));
    EXPECT_EQ(visits, 1);
  }
}

TEST(VisitSchedule, LeavesTheVisitsToAnExecutorThatMakesThem)
{
  const VisitSchedule schedule = Apart(6);
  for (const bool goesOn : { true, false })
  {
    OwnWay executor;
    std::vector<int> visited;
    std::vector<std::size_t> asked;
    EXPECT_EQ(schedule.Run(executor,
                [&visited](int item, std::size_t, Executor&) { visited.push_back(item); },
                [&](std::size_t done)
                {
                  asked.push_back(done);
                  return goesOn;
                }),
      goesOn);
    EXPECT_EQ(visited, (std::vector<int>{ 5, 4, 3, 2, 1, 0 }));
    EXPECT_EQ(asked, std::vector<std::size_t>{ 6 });
    EXPECT_EQ(executor.Calls, 0);
  }
}
