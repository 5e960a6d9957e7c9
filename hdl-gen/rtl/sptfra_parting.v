// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// What the forces of each body's region cause everywhere: for each row of the grid and each body the sums of all
// columns at once, over the taxels of its region, one a cycle.
//
// From start to done: ROWS times the sum over bodies of the larger of the region's taxels and COLUMNS, and COLUMNS +
// 13 cycles.

`default_nettype none

module sptfra_parting #(
    // Taxels in x and y
    parameter COLUMNS = 10,
    parameter ROWS = 10,
    // Bodies, and bits of the number of one
    parameter CONTACTS = 4,
    parameter BODY_WIDTH = 2,
    // Coefficients by distance
    parameter ROM_DIR = "",
    parameter FILE = "",
    // Derived
    parameter TAXEL_WIDTH = (COLUMNS * ROWS > 8) ? $clog2(COLUMNS * ROWS) : 3
) (
    input  wire clock,
    input  wire reset,
    input  wire start,
    input  wire [3:0] kept, // bodies; held
    output reg  done, // one cycle
    // The taxels by body, from sptfra_regions; what is asked for is there a cycle later
    input  wire [CONTACTS*(TAXEL_WIDTH+1)-1:0] sizes,
    output wire [TAXEL_WIDTH-1:0] list_address,
    input  wire [TAXEL_WIDTH-1:0] list_taxel,
    // Their forces, a cycle later
    output wire [TAXEL_WIDTH-1:0] force_taxel,
    input  wire [80:0] forces,
    // What a body causes at a taxel: body in the highest bits; 1 cycle
    input  wire part_enable,
    input  wire [BODY_WIDTH+TAXEL_WIDTH-1:0] part_address,
    output wire signed [47:0] part
);

    localparam COLUMN_WIDTH = (COLUMNS > 2) ? $clog2(COLUMNS) : 1;
    localparam ROW_WIDTH = (ROWS > 2) ? $clog2(ROWS) : 1;
    localparam SIZE_WIDTH = TAXEL_WIDTH + 1;
    localparam [31:0] LAST_COLUMN = COLUMNS - 1;
    localparam [31:0] LAST_ROW = ROWS - 1;
    localparam [31:0] LAST_TAXEL = COLUMNS * ROWS - 1;
    localparam [31:0] COLUMNS_32 = COLUMNS;
    // From a place in the list to its force's sum
    localparam TO_SUM = 10;

    // ---- A pass for each row and body: its taxels, after a pause where they are fewer than the columns, so that the
    // sums before have left when they are there
    reg busy;
    reg [ROW_WIDTH-1:0] row;
    reg [3:0] body;
    reg [TAXEL_WIDTH-1:0] position;
    reg [SIZE_WIDTH-1:0] step;
    wire [SIZE_WIDTH-1:0] size = sizes[SIZE_WIDTH*body[BODY_WIDTH-1:0] +: SIZE_WIDTH];
    wire is_long = (size > LAST_COLUMN[SIZE_WIDTH-1:0]);
    wire [SIZE_WIDTH-1:0] pause = is_long ? {SIZE_WIDTH{1'b0}} : COLUMNS_32[SIZE_WIDTH-1:0] - size;
    wire has_source = busy && (step >= pause);
    wire ends_pass = busy && (step + 1'b1 == (is_long ? size : COLUMNS_32[SIZE_WIDTH-1:0]));
    wire ends_row = ends_pass && (body + 4'd1 == kept);
    wire ends_all = ends_row && (row == LAST_ROW[ROW_WIDTH-1:0]);

    assign list_address = position;
    assign force_taxel = list_taxel;

    always @(posedge clock) begin
        if (busy) begin
            step <= ends_pass ? {SIZE_WIDTH{1'b0}} : step + 1'b1;
            if (ends_pass) begin
                body <= ends_row ? 4'd0 : body + 4'd1;
            end
            if (ends_row) begin
                position <= {TAXEL_WIDTH{1'b0}};
                row <= row + 1'b1;
            end else if (has_source) begin
                position <= position + 1'b1;
            end
            if (ends_all) begin
                busy <= 1'b0;
            end
        end
        if (start) begin
            busy <= 1'b1;
            row <= {ROW_WIDTH{1'b0}};
            body <= 4'd0;
            position <= {TAXEL_WIDTH{1'b0}};
            step <= {SIZE_WIDTH{1'b0}};
        end
        if (reset) begin
            busy <= 1'b0;
        end
    end

    // ---- Where a taxel is: written once, as the taxels are counted after the reset
    reg placing;
    reg [TAXEL_WIDTH-1:0] placed;
    reg [COLUMN_WIDTH-1:0] placed_column;
    reg [ROW_WIDTH-1:0] placed_row;
    wire [COLUMN_WIDTH-1:0] column_2;
    wire [ROW_WIDTH-1:0] row_2;

    always @(posedge clock) begin
        if (placing) begin
            placed <= placed + 1'b1;
            placed_column <= placed_column + 1'b1;
            if (placed_column == LAST_COLUMN[COLUMN_WIDTH-1:0]) begin
                placed_column <= {COLUMN_WIDTH{1'b0}};
                placed_row <= placed_row + 1'b1;
            end
            if (placed == LAST_TAXEL[TAXEL_WIDTH-1:0]) begin
                placing <= 1'b0;
            end
        end
        if (reset) begin
            placing <= 1'b1;
            placed <= {TAXEL_WIDTH{1'b0}};
            placed_column <= {COLUMN_WIDTH{1'b0}};
            placed_row <= {ROW_WIDTH{1'b0}};
        end
    end

    sptfra_ram #(
        .WIDTH         (ROW_WIDTH + COLUMN_WIDTH),
        .DEPTH         (1 << TAXEL_WIDTH),
        .ADDRESS_WIDTH (TAXEL_WIDTH)
    ) places (
        .clock         (clock),
        .write_enable  (placing),
        .write_address (placed),
        .write_data    ({placed_row, placed_column}),
        .read_enable   (!placing),
        .read_address  (list_taxel),
        .read_data     ({row_2, column_2})
    );

    // ---- Beside list and memory, 2 cycles: which force it is
    reg [2:1] valid;
    reg [2:1] first;
    reg [TO_SUM:1] sums_there; // the last force of a sum
    reg [TO_SUM:1] all_there; // of all sums
    reg [ROW_WIDTH-1:0] target_1, target_2;
    wire from_below_2 = (row_2 > target_2);
    reg [80:0] forces_3, forces_4, forces_5; // for all columns, while each looks up its coefficients

    always @(posedge clock) begin
        valid <= {valid[1], has_source};
        first <= {first[1], step == pause};
        sums_there <= {sums_there[TO_SUM-1:1], ends_pass};
        all_there <= {all_there[TO_SUM-1:1], ends_all};
        {target_2, target_1} <= {target_1, row};
        {forces_5, forces_4, forces_3} <= {forces_4, forces_3, forces};
        if (reset) begin
            valid <= 2'd0;
            sums_there <= {TO_SUM{1'b0}};
            all_there <= {TO_SUM{1'b0}};
        end
    end

    wire [48*COLUMNS-1:0] sums;
    genvar index;

    generate
        for (index = 0; index < COLUMNS; index = index + 1) begin : gen_lane
            sptfra_parting_lane #(
                .COLUMN       (index),
                .COLUMN_WIDTH (COLUMN_WIDTH),
                .ROW_WIDTH    (ROW_WIDTH),
                .ROM_DIR      (ROM_DIR),
                .FILE         (FILE)
            ) lane (
                .clock       (clock),
                .reset       (reset),
                .valid       (valid[2]),
                .first       (first[2]),
                .from_column (column_2),
                .rows_away   (from_below_2 ? row_2 - target_2 : target_2 - row_2),
                .from_below  (from_below_2),
                .forces_3    (forces_5),
                .sum         (sums[48*index +: 48])
            );
        end
    endgenerate

    // ---- The sums of a row go to the memory one after the other, in the order of the passes
    reg [48*COLUMNS-1:0] leaving;
    reg [COLUMN_WIDTH-1:0] leaving_column;
    reg leaves;
    reg [3:0] leaving_body;
    reg [TAXEL_WIDTH-1:0] row_begin;
    reg is_last;
    wire last_leaves = leaves && (leaving_column == LAST_COLUMN[COLUMN_WIDTH-1:0]);
    wire [TAXEL_WIDTH-1:0] leaving_taxel = row_begin + {{(TAXEL_WIDTH-COLUMN_WIDTH){1'b0}}, leaving_column};

    always @(posedge clock) begin
        leaving <= {48'd0, leaving[48*COLUMNS-1:48]};
        leaving_column <= leaving_column + 1'b1;
        if (last_leaves) begin
            leaves <= 1'b0;
            leaving_body <= (leaving_body + 4'd1 == kept) ? 4'd0 : leaving_body + 4'd1;
            if (leaving_body + 4'd1 == kept) begin
                row_begin <= row_begin + COLUMNS_32[TAXEL_WIDTH-1:0];
            end
        end
        if (sums_there[TO_SUM]) begin
            leaving <= sums;
            leaving_column <= {COLUMN_WIDTH{1'b0}};
            leaves <= 1'b1;
        end
        is_last <= all_there[TO_SUM] || (is_last && !last_leaves);
        done <= is_last && last_leaves;
        if (start) begin
            leaving_body <= 4'd0;
            row_begin <= {TAXEL_WIDTH{1'b0}};
        end
        if (reset) begin
            leaves <= 1'b0;
            is_last <= 1'b0;
            done <= 1'b0;
        end
    end

    sptfra_ram #(
        .WIDTH         (48),
        .DEPTH         (1 << (BODY_WIDTH + TAXEL_WIDTH)),
        .ADDRESS_WIDTH (BODY_WIDTH + TAXEL_WIDTH)
    ) parts (
        .clock         (clock),
        .write_enable  (leaves),
        .write_address ({leaving_body[BODY_WIDTH-1:0], leaving_taxel}),
        .write_data    (leaving[47:0]),
        .read_enable   (part_enable),
        .read_address  (part_address),
        .read_data     (part)
    );

`ifdef SIMULATION
    always @(posedge clock) begin
        if (!reset && sums_there[TO_SUM] && leaves && !last_leaves) begin
            $fdisplay(32'h80000002, "%m: the sums of a row come before those before them have left");
            $finish;
        end
    end
`endif

endmodule

`default_nettype wire
