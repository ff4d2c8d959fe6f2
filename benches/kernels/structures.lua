-- Points of a grid are turned around a middle, step by step: arrays of poses and joints, read and written by component.
local function structures(rounds)
  local grid, seat = {}, {}
  for i = 0, 199 do
    grid[i] = { x = 500.0 + i % 20 * 10, y = i // 20 * 10.0 - 50, z = 300.0, a = 0.0, b = 90.0, c = 0.0 }
    seat[i] = { j1 = 0.0, j2 = -90.0, j3 = 90.0, j4 = 0.0, j5 = 90.0, j6 = 0.0 }
  end
  local abs = math.abs
  local function turn(middle, cosine, sine)
    local moved = 0.0
    for i = 0, 199 do
      local dx = grid[i].x - middle.x
      local dy = grid[i].y - middle.y
      local x = middle.x + dx * cosine - dy * sine
      local y = middle.y + dx * sine + dy * cosine
      moved = moved + abs(x - grid[i].x) + abs(y - grid[i].y)
      grid[i].x = x
      grid[i].y = y
      grid[i].z = grid[i].z * 0.999 + middle.z * 0.001
      seat[i].j1 = seat[i].j1 + dx * 0.01
      if seat[i].j1 > 170 then
        seat[i].j1 = seat[i].j1 - 340
      end
      seat[i].j2 = seat[i].j2 + (grid[i].z - 300) * 0.001
      seat[i].j6 = seat[i].j1 - seat[i].j2
    end
    return moved
  end
  local middle = { x = 590.0, y = -20.0, z = 410.0, a = 0.0, b = 90.0, c = 0.0 }
  local sum = 0.0
  for round = 1, rounds do
    middle.x = middle.x + 0.25
    middle.y = middle.y - 0.125
    sum = sum + turn(middle, 0.999, 0.0447)
  end
  return sum + seat[199].j6 + grid[199].x
end

return structures
