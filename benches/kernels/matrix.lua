-- Multiplies two matrices of 60 by 60, many times; each product goes into the next one.
local function matrix(rounds)
  local a, b = {}, {}
  for i = 0, 59 do
    a[i], b[i] = {}, {}
    for j = 0, 59 do
      a[i][j] = (i * 7 + j * 3) % 11 / 60.0
      b[i][j] = (i * 5 + j * 13) % 17 / 480.0
    end
  end
  for round = 1, rounds do
    local c = {}
    for i = 0, 59 do
      local row, out = a[i], {}
      for j = 0, 59 do
        local sum = 0.0
        for k = 0, 59 do
          sum = sum + row[k] * b[k][j]
        end
        out[j] = sum
      end
      c[i] = out
    end
    a = c
  end
  local trace = 0.0
  for i = 0, 59 do
    trace = trace + a[i][i]
  end
  return trace
end

return matrix
