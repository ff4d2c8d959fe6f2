-- A machine that takes parts apart by weight, written with goto.
local function wrap(n)
  n = n & 0xffffffff
  return n < 0x80000000 and n or n - 0x100000000
end

local function machine(parts)
  local seed, weight, good, bad, held, left = 1, 0, 0, 0, 0, parts
  ::next::
  if left == 0 then goto done end
  left = left - 1
  seed = wrap(seed * 1103515245 + 12345)
  weight = seed >> 16 & 0xff
  if weight < 20 then goto reject end
  if weight > 200 then goto hold end
  ::accept::
  good = good + weight
  if held > 3 then goto release end
  goto next
  ::reject::
  bad = bad + 1
  if bad % 8 == 0 then goto release end
  goto next
  ::hold::
  held = held + 1
  if held < 8 then goto next end
  ::release::
  if held == 0 then goto next end
  held = held - 1
  weight = weight // 2
  if weight > 90 then goto reject end
  goto accept
  ::done::
  do return wrap(good * 31 + bad * 7 + held) end
end

return machine
