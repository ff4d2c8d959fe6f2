-- CRC-32 of 8 KiB, many times, each with the result of the one before among its data.
local function crc(rounds)
  local tab, data = {}, {}
  for i = 0, 255 do
    local c = i
    for bit = 1, 8 do
      if c & 1 == 1 then
        c = (c >> 1) ~ 0xedb88320
      else
        c = c >> 1
      end
    end
    tab[i] = c
  end
  local function put(value, at)
    for i = 0, 3 do
      data[at + i] = (value >> (8 * i)) & 0xff
    end
  end
  for i = 0, 8191, 4 do
    put((i * 1103515245 + 12345) & 0xffffffff, i)
  end
  local sum = 0
  for round = 0, rounds - 1 do
    local c = 0xffffffff
    for i = 0, 8191 do
      c = tab[(c ~ data[i]) & 0xff] ~ (c >> 8)
    end
    c = ~c & 0xffffffff
    put(c, round % 2048 * 4)
    sum = sum ~ c
  end
  return sum < 0x80000000 and sum or sum - 0x100000000
end

return crc
