-- Runs a kernel many times: lua rounds.lua FILE SIZE ROUNDS. Prints its checksum, the shortest and the middle time in s.
local kernel, size, rounds = dofile(arg[1]), tonumber(arg[2]), tonumber(arg[3])
local checksum
local times = {}
for round = 1, rounds do
  local start = os.clock()
  checksum = kernel(size)
  times[round] = os.clock() - start
end
table.sort(times)
print(string.format("%.17g %.9f %.9f", checksum, times[1], times[rounds // 2 + 1]))
