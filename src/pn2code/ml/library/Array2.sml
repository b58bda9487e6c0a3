(* Arrays with rows and columns: how many of each, and the elements row by row. *)
structure Array2 = struct
    datatype 'a array = Array2 of int * int * 'a Array.array
    type 'a region = {base : 'a array, row : int, col : int, nrows : int option, ncols : int option}
    datatype traversal = RowMajor | ColMajor

    fun sized (rows, columns) =
        if rows < 0 orelse columns < 0 orelse (rows > 0 andalso columns > Array.maxLen div rows) then raise Size
        else rows * columns
    fun array (rows, columns, x) = Array2 (rows, columns, Array.array (sized (rows, columns), x))
    fun fromList nil = Array2 (0, 0, Array.fromList nil)
      | fromList (rows as first :: others) =
        if List.all (fn row => List.length row = List.length first) others then
            Array2 (List.length rows, List.length first, Array.fromList (List.concat rows))
        else raise Size

    fun dimensions (Array2 (rows, columns, _)) = (rows, columns)
    fun nRows (Array2 (rows, _, _)) = rows
    fun nCols (Array2 (_, columns, _)) = columns
    fun at (Array2 (rows, columns, _), i, j) =
        if i < 0 orelse i >= rows orelse j < 0 orelse j >= columns then raise Subscript else i * columns + j
    fun sub (whole as Array2 (_, _, items), i, j) = Array.sub (items, at (whole, i, j))
    fun update (whole as Array2 (_, _, items), i, j, x) = Array.update (items, at (whole, i, j), x)
    fun row (whole as Array2 (rows, columns, _), i) =
        if i < 0 orelse i >= rows then raise Subscript
        else Vector.tabulate (columns, fn j => sub (whole, i, j))
    fun column (whole as Array2 (rows, columns, _), j) =
        if j < 0 orelse j >= columns then raise Subscript
        else Vector.tabulate (rows, fn i => sub (whole, i, j))

    fun visit RowMajor (rows, columns) f z =
        let fun each (i, j, out) =
                if i >= rows orelse columns = 0 then out
                else if j >= columns then each (i + 1, 0, out)
                else each (i, j + 1, f (i, j, out))
        in each (0, 0, z) end
      | visit ColMajor (rows, columns) f z = visit RowMajor (columns, rows) (fn (j, i, out) => f (i, j, out)) z

    fun tabulate order (rows, columns, f) =
        let val found = Array.fromList (List.tabulate (sized (rows, columns), fn _ => NONE))
            val _ = visit order (rows, columns) (fn (i, j, ()) => Array.update (found, i * columns + j, SOME (f (i, j)))) ()
        in Array2 (rows, columns, Array.tabulate (rows * columns, fn i => valOf (Array.sub (found, i)))) end

    fun extent (size, start, NONE) = if start < 0 orelse start > size then raise Subscript else size - start
      | extent (size, start, SOME n) =
        if start < 0 orelse n < 0 orelse start > size orelse n > size - start then raise Subscript else n
    fun size {base, row, col, nrows, ncols} =
        (extent (nRows base, row, nrows), extent (nCols base, col, ncols))
    fun foldi order f z (part as {base, row, col, nrows, ncols}) =
        visit order (size part) (fn (i, j, out) => f (row + i, col + j, sub (base, row + i, col + j), out)) z
    fun all whole = {base = whole, row = 0, col = 0, nrows = NONE, ncols = NONE}
    fun fold order f z whole = foldi order (fn (_, _, x, out) => f (x, out)) z (all whole)
    fun appi order f part = foldi order (fn (i, j, x, ()) => f (i, j, x) : unit) () part
    fun app order f whole = appi order (fn (_, _, x) => f x) (all whole)
    fun modifyi order f (part : 'a region) = appi order (fn (i, j, x) => update (#base part, i, j, f (i, j, x))) part
    fun modify order f whole = modifyi order (fn (_, _, x) => f x) (all whole)
    fun copy {src : 'a region, dst, dst_row, dst_col} =
        let val (rows, columns) = size src
            val _ = (extent (nRows dst, dst_row, SOME rows), extent (nCols dst, dst_col, SOME columns))
            val kept = tabulate RowMajor (rows, columns, fn (i, j) => sub (#base src, #row src + i, #col src + j))
        in
            appi RowMajor (fn (i, j, x) => update (dst, dst_row + i, dst_col + j, x)) (all kept)
        end
end
