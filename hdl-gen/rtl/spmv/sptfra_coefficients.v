// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Coefficient vectors g_pq (Eqs. 11 to 13), their sums over the frame and those of their torques, taxel by taxel.
//
// A_p b waits in a memory of its own until D_p0 w arrives. Every finished g goes to the field memory, into the sum
// G_pq and, times the taxel's arms, into the torques' sums. Where the lanes multiply g again, it goes to the operand
// memories too. Result bus to g: 3 cycles; to a torque's sum: 6.

`default_nettype none

module sptfra_coefficients #(
    // Taxels
    parameter ELEMENTS = 100,
    // Bits of a value
    parameter DATA_BITS = 27,
    // Words of the operand memories, and where g30, g31 and g32 stand there, unless in the stress's bank
    parameter OPERAND_DEPTH = 600,
    parameter [63:0] STORE_BASES = 64'd0,
    parameter [3:0] STORE_IN_BANK = 4'd0,
    // Prefix of the ROM file name, and what it begins with: the taxels' arms
    parameter ROM_DIR = "",
    parameter ROM_NAME = "",
    // Derived
    parameter ROW_WIDTH = (ELEMENTS > 8) ? $clog2(ELEMENTS) : 3,
    parameter OPERAND_WIDTH = (OPERAND_DEPTH > 2) ? $clog2(OPERAND_DEPTH) : 1,
    parameter COMPONENT_WIDTH = $clog2(3 * ELEMENTS)
) (
    input  wire clock,
    input  wire reset,
    // Result bus
    input  wire [2:0] result_partial, // A_p b, at p - 1
    input  wire [8:0] result_g, // g_pq at 3 (p - 1) + q
    input  wire [ROW_WIDTH-1:0] result_row,
    input  wire signed [DATA_BITS-1:0] result_value,
    // Operand memories
    input  wire bank, // of the frame's stress
    output wire write_next, // write_valid of the next cycle
    output wire write_valid,
    output wire [OPERAND_WIDTH-1:0] write_address,
    output wire [DATA_BITS-1:0] write_data,
    // To the field: g_pq of component 3 i + p - 1
    output wire [2:0] g_valid, // of q
    output reg  [COMPONENT_WIDTH-1:0] g_component,
    output reg  signed [DATA_BITS-1:0] g,
    // Frame sums
    output reg  sums_there, // one cycle, when the last g is in all of them
    output wire [18*40-1:0] sums
);

    // ---- Whose a result is: component 3 i + p - 1, and p here is one less
    wire [1:0] p = {result_partial[2] || (result_g[8:6] != 3'd0), result_partial[1] || (result_g[5:3] != 3'd0)};
    wire [31:0] row_wide = {{(32-ROW_WIDTH){1'b0}}, result_row};
    wire [COMPONENT_WIDTH-1:0] row_short = row_wide[COMPONENT_WIDTH-1:0];
    wire [COMPONENT_WIDTH-1:0] component = row_short + row_short + row_short + {{(COMPONENT_WIDTH-2){1'b0}}, p};

    // ---- A_p b
    reg partial_write;
    reg [COMPONENT_WIDTH-1:0] component_1;
    reg signed [DATA_BITS-1:0] value_1;
    wire signed [DATA_BITS-1:0] partial;

    sptfra_ram #(
        .WIDTH         (DATA_BITS),
        .DEPTH         (3 * ELEMENTS),
        .ADDRESS_WIDTH (COMPONENT_WIDTH)
    ) partials (
        .clock         (clock),
        .write_enable  (partial_write),
        .write_address (component_1),
        .write_data    (value_1),
        .read_enable   (1'b1),
        .read_address  (component),
        .read_data     (partial)
    );

    // ---- g = D_p0 w + A_p b, or as it comes. Index k: k cycles after the result
    reg [8:0] is_g_1;
    reg [8:0] is_g_2;
    reg [8:0] is_g_3; // at 3 (p - 1) + q
    reg [ROW_WIDTH-1:0] row_1;
    reg [ROW_WIDTH-1:0] row_2;
    reg [ROW_WIDTH-1:0] row_3;
    reg [COMPONENT_WIDTH-1:0] component_2;
    reg signed [DATA_BITS-1:0] value_2;
    reg signed [DATA_BITS-1:0] partial_2;
    localparam signed [DATA_BITS-1:0] ZERO = 0;

    assign g_valid = is_g_3[2:0] | is_g_3[5:3] | is_g_3[8:6];

    always @(posedge clock) begin
        partial_write <= (result_partial != 3'd0);
        is_g_1 <= result_g;
        is_g_2 <= is_g_1;
        is_g_3 <= is_g_2;
        row_1 <= result_row;
        row_2 <= row_1;
        row_3 <= row_2;
        component_1 <= component;
        component_2 <= component_1;
        g_component <= component_2;
        value_1 <= result_value;
        value_2 <= value_1;
        partial_2 <= (is_g_1[0] || is_g_1[3] || is_g_1[6]) ? partial : ZERO;
        g <= value_2 + partial_2;
        if (reset) begin
            partial_write <= 1'b0;
            is_g_1 <= 9'd0;
            is_g_2 <= 9'd0;
            is_g_3 <= 9'd0;
        end
    end

    // ---- Operands of u_q = C33 g_3q; by the time g30 comes, nothing reads this frame's stress any more
    localparam [31:0] LENGTH = ELEMENTS;
    wire [31:0] stored_row = {{(32-ROW_WIDTH){1'b0}}, row_3};
    wire [1:0] q = {is_g_3[8], is_g_3[7]};
    wire [15:0] base = STORE_BASES[16*q +: 16];
    wire [OPERAND_WIDTH-1:0] bank_base = bank ? LENGTH[OPERAND_WIDTH-1:0] : {OPERAND_WIDTH{1'b0}};

    assign write_next = (is_g_2[8:6] != 3'd0);
    assign write_valid = (is_g_3[8:6] != 3'd0);
    assign write_address = (STORE_IN_BANK[q] ? bank_base : base[OPERAND_WIDTH-1:0]) + stored_row[OPERAND_WIDTH-1:0];
    assign write_data = g;

    // ---- Frame sums: each begins anew with the first of its frame
    localparam TOTAL = 9 * ELEMENTS;
    localparam COUNT_WIDTH = $clog2(TOTAL + 1);
    reg [COUNT_WIDTH-1:0] count;
    wire last = (count == TOTAL - 1);
    wire signed [39:0] g_wide = {{(40-DATA_BITS){g[DATA_BITS-1]}}, g};
    reg [5:4] lasts;

    always @(posedge clock) begin
        {sums_there, lasts} <= {lasts, (g_valid != 3'd0) && last};
        if (g_valid != 3'd0) begin
            count <= last ? {COUNT_WIDTH{1'b0}} : count + 1;
        end
        if (reset) begin
            count <= {COUNT_WIDTH{1'b0}};
            {sums_there, lasts} <= 3'd0;
        end
    end

    genvar index;
    for (index = 0; index < 9; index = index + 1) begin : gen_sums
        reg signed [39:0] sum;
        reg fresh;

        always @(posedge clock) begin
            if (is_g_3[index]) begin
                sum <= (fresh ? 40'sd0 : sum) + g_wide;
                fresh <= 1'b0;
            end
            if (reset || sums_there) begin
                fresh <= 1'b1;
            end
        end

        assign sums[40*index +: 40] = sum;
    end

    // ---- Torques: g times the arms, rounded to steps of g. Index k: k cycles after the result
    localparam integer ARM_FRACTION = 16;
    localparam signed [44:0] ARM_HALF = 45'sd1 <<< (ARM_FRACTION - 1);
    localparam integer ARM_WIDTH = $clog2(ELEMENTS); // a row has three bits even of four taxels
    wire [35:0] arms; // along x in the lower half
    reg [8:0] is_g_4;
    reg [8:0] is_g_5;

    sptfra_rom #(
        .WIDTH         (36),
        .DEPTH         (ELEMENTS),
        .ADDRESS_WIDTH (ARM_WIDTH),
        .ROM_DIR       (ROM_DIR),
        .FILE          ((ROM_NAME == "") ? "" : {ROM_NAME, "_arms.mem"})
    ) taxel_arms (
        .clock   (clock),
        .enable  (1'b1),
        .address (row_2[ARM_WIDTH-1:0]),
        .data    (arms)
    );

    always @(posedge clock) begin
        is_g_4 <= is_g_3;
        is_g_5 <= is_g_4;
        if (reset) begin
            is_g_4 <= 9'd0;
            is_g_5 <= 9'd0;
        end
    end

    wire signed [39:0] moment_5 [0:1]; // of the arm along x, along y

    for (index = 0; index < 2; index = index + 1) begin : gen_moments
        wire signed [44:0] product_4;
        reg signed [44:0] rounded_5;

        sptfra_multiply times_arm (
            .clock       (clock),
            .enable      (1'b1),
            .coefficient (arms[18*index +: 18]),
            .data        (g_wide[26:0]),
            .product     (product_4)
        );

        always @(posedge clock) begin
            rounded_5 <= product_4 + ARM_HALF;
        end

        assign moment_5[index] = {{(ARM_FRACTION - 5){rounded_5[44]}}, rounded_5[44:ARM_FRACTION]};

        wire _unused = &{1'b0, rounded_5};
    end
    for (index = 0; index < 3; index = index + 1) begin : gen_torques
        // T_x: y f_z; T_y: -x f_z; T_z: x f_y - y f_x
        wire of_x = is_g_5[index];
        wire of_y = is_g_5[3+index];
        wire of_z = is_g_5[6+index];
        reg signed [39:0] torque_x;
        reg signed [39:0] torque_y;
        reg signed [39:0] torque_z;
        reg fresh; // no f_z of the frame yet
        reg fresh_z; // neither f_x nor f_y

        always @(posedge clock) begin
            if (of_z) begin
                torque_x <= (fresh ? 40'sd0 : torque_x) + moment_5[1];
                torque_y <= (fresh ? 40'sd0 : torque_y) - moment_5[0];
                fresh <= 1'b0;
            end
            if (of_x || of_y) begin
                torque_z <= (fresh_z ? 40'sd0 : torque_z) + (of_y ? moment_5[0] : -moment_5[1]);
                fresh_z <= 1'b0;
            end
            if (reset || sums_there) begin
                fresh <= 1'b1;
                fresh_z <= 1'b1;
            end
        end

        assign sums[40*(9+index) +: 40] = torque_x;
        assign sums[40*(12+index) +: 40] = torque_y;
        assign sums[40*(15+index) +: 40] = torque_z;
    end

    wire _unused = &{1'b0, row_wide, stored_row, base};

endmodule

`default_nettype wire
