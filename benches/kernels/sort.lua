-- Sorts 10000 numbers, many times: quicksort that calls itself, insertion for short parts.
local function wrap(n)
  n = n & 0xffffffff
  return n < 0x80000000 and n or n - 0x100000000
end

local function sort_part(data, low, high)
  while low < high do
    if high - low < 16 then
      for i = low + 1, high do
        local value, k = data[i], i - 1
        while k >= low and data[k] > value do
          data[k + 1] = data[k]
          k = k - 1
        end
        data[k + 1] = value
      end
      return
    end
    local pivot = data[(low + high) // 2]
    local i, k = low, high
    while i <= k do
      while data[i] < pivot do
        i = i + 1
      end
      while data[k] > pivot do
        k = k - 1
      end
      if i <= k then
        data[i], data[k] = data[k], data[i]
        i = i + 1
        k = k - 1
      end
    end
    sort_part(data, low, k)
    low = i
  end
end

local function sort(rounds)
  local data, seed, sum = {}, 12345, 0
  for round = 1, rounds do
    for i = 0, 9999 do
      seed = wrap(seed * 1103515245 + 12345)
      data[i] = seed >> 8 & 0xffffff
      if data[i] >= 0x800000 then
        data[i] = data[i] - 0x1000000
      end
    end
    sort_part(data, 0, 9999)
    for i = 0, 9999, 100 do
      sum = wrap(sum * 31 + data[i])
    end
  end
  return sum
end

return sort
