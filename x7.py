import json,re
# summarise x5 diffs ignoring the depth of clearance
