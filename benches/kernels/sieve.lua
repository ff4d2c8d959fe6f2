-- Counts the primes below 10000, many times.
local function sieve(rounds)
  local found = 0
  for round = 1, rounds do
    local composite = {}
    for i = 0, 9999 do
      composite[i] = false
    end
    for i = 2, 9999 do
      if not composite[i] then
        found = found + 1
        for k = i + i, 9999, i do
          composite[k] = true
        end
      end
    end
  end
  return found
end

return sieve
