-- The longest Collatz chain that starts below a limit.
local function wrap(n)
  n = n & 0xffffffff
  return n < 0x80000000 and n or n - 0x100000000
end

local function chain(start)
  local n, steps = start, 0
  while n ~= 1 do
    if n % 2 == 0 then
      n = n // 2
    else
      n = 3 * n + 1
    end
    steps = steps + 1
  end
  return steps
end

local function collatz(limit)
  local longest, sum = 0, 0
  for start = 1, limit - 1 do
    local steps = chain(start)
    sum = sum + steps
    if steps > longest then
      longest = steps
    end
  end
  return wrap(sum * 1000 + longest)
end

return collatz
