-- Builds lines of text from names and numbers, and adds up some of their characters.
local function wrap(n)
  n = n & 0xffffffff
  return n < 0x80000000 and n or n - 0x100000000
end

local function text(lines)
  local names = { [0] = "gripper", "conveyor", "press", "table" }
  local all, sum = "", 0
  for i = 0, lines - 1 do
    local line = names[i % 4] .. " part " .. tostring(i)
    if i % 3 == 0 then
      line = line .. " rejected"
    else
      line = line .. " placed"
    end
    all = all .. line .. ";"
    if #all > 4000 then
      sum = wrap(sum * 31 + #all)
      for k = 0, 99 do
        sum = wrap(sum * 7 + all:byte(k * 40 + 1))
      end
      all = ""
    end
  end
  return wrap(sum + #all)
end

return text
