fun col (colour @ _) = colour
