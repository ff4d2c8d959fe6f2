-- Points of a path that follow a leader: arrays of poses and joints, read and written by component.
local function structures(rounds)
  local path, seat = {}, {}
  for i = 0, 199 do
    path[i] = { x = 500.0 + i, y = i * 0.5, z = 300.0, a = 0.0, b = 90.0, c = 0.0 }
    seat[i] = { j1 = 0.0, j2 = -90.0, j3 = 90.0, j4 = 0.0, j5 = 90.0, j6 = 0.0 }
  end
  local function step_to(target, share)
    local moved = 0.0
    for i = 1, 199 do
      local dx = path[i - 1].x - path[i].x
      local dy = path[i - 1].y - path[i].y
      local dz = path[i - 1].z - path[i].z
      path[i].x = path[i].x + dx * share
      path[i].y = path[i].y + dy * share
      path[i].z = path[i].z + dz * share
      seat[i].j1 = seat[i].j1 + dy * 0.01
      seat[i].j2 = seat[i].j2 - dx * 0.02
      seat[i].j3 = seat[i - 1].j2 + seat[i].j1
      moved = moved + dx * dx + dy * dy + dz * dz
    end
    path[0].x = target.x
    path[0].y = target.y
    path[0].z = target.z
    return moved
  end
  local target = { x = 600.0, y = -20.0, z = 410.0, a = 0.0, b = 90.0, c = 0.0 }
  local sum = 0.0
  for round = 1, rounds do
    target.x = target.x + 0.25
    target.y = target.y - 0.125
    sum = sum + step_to(target, 0.4)
  end
  return sum + seat[199].j3 + path[199].x
end

return structures
