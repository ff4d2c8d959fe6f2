-- A Mandelbrot set in fixed-point numbers with 12 bits behind the point.
local function wrap(n)
  n = n & 0xffffffff
  return n < 0x80000000 and n or n - 0x100000000
end

local function quotient(a, b)
  return a >= 0 and a // b or -(-a // b)
end

local function fixed(rows)
  local sum = 0
  for row = 0, rows - 1 do
    local ci = quotient(row * 8192, rows) - 4096
    for column = 0, 119 do
      local cr = quotient(column * 12288, 120) - 8192
      local x, y, n, xx, yy = 0, 0, 0, 0, 0
      while n < 100 and xx + yy < 16384 do
        y = (x * y // 2048) + ci
        x = xx - yy + cr
        xx = x * x // 4096
        yy = y * y // 4096
        n = n + 1
      end
      sum = wrap((sum << 1) ~ sum ~ n)
    end
  end
  return sum
end

return fixed
