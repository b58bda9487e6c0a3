structure ListFormat = struct
    fun fmt {init, sep, final, fmt} items = init ^ String.concatWith sep (List.map fmt items) ^ final
    fun listToString f items = fmt {init = "[", sep = ",", final = "]", fmt = f} items
end
