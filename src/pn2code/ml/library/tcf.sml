fun tcf (colour, tokens) = List.length (List.filter (fn c @ _ => c = colour) tokens)
