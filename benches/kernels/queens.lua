-- Counts the ways to place queens on a board so that none attacks another, by a function that calls itself.
local function place(row, size, columns, up, down)
  if row == size then
    return 1
  end
  local count = 0
  for i = 0, size - 1 do
    local here = 1 << i
    if (columns | up | down) & here == 0 then
      count = count + place(row + 1, size, columns | here, (up | here) << 1, (down | here) >> 1)
    end
  end
  return count
end

return function(size)
  return place(0, size, 0, 0, 0)
end
