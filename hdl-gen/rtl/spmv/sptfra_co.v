// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Co: sums G_pq of the coefficient vectors over the frame (Eqs. 11 to 13) and of their torques about the grid's
// middle. It also selects the results that the lanes multiply again.
//
// Of a folded grid the sums are dot products of y+ and |w| with constant rows, which the lanes compute. The residual
// stress for the field passes through to the operand memories in 1 cycle. Where taxels are not folded, the
// coefficient vectors themselves come, see sptfra_coefficients. The array adds one cycle.

`default_nettype none

module sptfra_co #(
    // 4: parity components; 1: taxels
    parameter CHANNELS = 4,
    // Elements of a vector: taxels, or orbits of a folded grid
    parameter ELEMENTS = 25,
    // Bits of a value
    parameter DATA_BITS = 27,
    // Words of the operand memories; where r0, r1, r2 and r, or g30, g31 and g32, stand there, unless in the stress's
    // bank
    parameter OPERAND_DEPTH = 200,
    parameter [63:0] STORE_BASES = 64'd0,
    parameter [3:0] STORE_IN_BANK = 4'd0,
    // Words from r0, r1 and r2 to their other bank, if they have two
    parameter [15:0] RESIDUAL_BANK = 16'd0,
    // Prefix of the ROM file names, and what they begin with: taxels' arms, where they are not folded
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
    input  wire [8:0] result_g, // of taxels g_pq at 3 (p - 1) + q, of components their sums at 0
    input  wire [3:0] result_kept, // of taxels A_p b at p - 1, of components r, r2, r1, r0
    input  wire [ROW_WIDTH-1:0] result_row,
    input  wire [CHANNELS*DATA_BITS-1:0] result_value,
    // Operand memories
    input  wire bank, // of the frame's stress
    input  wire residual_bank, // of the residual
    output wire write_next, // write_valid of the next cycle
    output wire write_valid,
    output wire [OPERAND_WIDTH-1:0] write_address,
    output wire [CHANNELS*DATA_BITS-1:0] write_data,
    // Coefficient vectors, to the field: g_pq of component 3 i + p - 1
    output wire [2:0] g_valid, // of q
    output wire [COMPONENT_WIDTH-1:0] g_component,
    output wire signed [DATA_BITS-1:0] g,
    output wire g_last, // one cycle, when all of a frame are there
    // Frame sums, G10 in the lowest 40 bits, then G11, G12, G20, ... G32, in the same way those of T_x, T_y and T_z
    output reg  sums_complete, // until they are taken
    input  wire sums_take,
    output wire [18*40-1:0] sums
);

    wire sums_there;

    always @(posedge clock) begin
        if (sums_there) begin
            sums_complete <= 1'b1;
        end else if (sums_take) begin
            sums_complete <= 1'b0;
        end
        if (reset) begin
            sums_complete <= 1'b0;
        end
    end

    // ---- Cycles from the result bus, which simulations check: to the write of an operand, to all sums being complete
    localparam WRITE_LATENCY = (CHANNELS == 4) ? 1 : 3;

    sptfra_check_latency #(
        .CYCLES    (WRITE_LATENCY),
        .PIPELINED (1)
    ) check_write (
        .clock (clock),
        .reset (reset),
        .start ((CHANNELS == 4) ? (result_kept != 4'd0) : (result_g[8:6] != 3'd0)),
        .done  (write_valid)
    );

`ifdef SIMULATION
    localparam SUMS_LATENCY = (CHANNELS == 4) ? 2 : 7;
    // The last of a frame's results that add up to sums
    localparam integer SUMMANDS = (CHANNELS == 4) ? 7 : 9 * ELEMENTS;
    integer summands;
    wire summand = (result_g != 9'd0);
    wire last_summand = summand && (summands == SUMMANDS - 1);
    reg sums_were_there;

    always @(posedge clock) begin
        sums_were_there <= sums_there;
        if (summand) begin
            summands <= last_summand ? 0 : summands + 1;
        end
        if (reset) begin
            sums_were_there <= 1'b0;
            summands <= 0;
        end
    end

    sptfra_check_latency #(
        .CYCLES    (SUMS_LATENCY),
        .PIPELINED (1)
    ) check_sums (
        .clock (clock),
        .reset (reset),
        .start (last_summand),
        .done  (sums_were_there)
    );
`endif

    if (CHANNELS == 4) begin : gen_folded
        // ---- Sums: row q has G_pq, and T_z's, in the component on which it depends, row 4 + q those of T_x and
        // T_y; row 3 what the weights take from F_z, T_x and T_y
        reg [2:0] sums_count;
        // A register on the way from the result bus
        reg sum_valid;
        reg [2:0] sum_row;
        reg signed [4*DATA_BITS-1:0] sum_value;
        // As they come: G_pq at 3 (p - 1) + q, those of the torques at q
        reg [9*40-1:0] g_sums;
        reg [3*40-1:0] x_sums;
        reg [3*40-1:0] y_sums;
        reg [3*40-1:0] z_sums;
        // Of q = 0, the weights' share of f_z, T_x and T_y
        reg [39:0] share_z;
        reg [39:0] share_x;
        reg [39:0] share_y;
        wire [DATA_BITS-1:0] value_0 = sum_value[DATA_BITS*0 +: DATA_BITS];
        wire [DATA_BITS-1:0] value_1 = sum_value[DATA_BITS*1 +: DATA_BITS];
        wire [DATA_BITS-1:0] value_2 = sum_value[DATA_BITS*2 +: DATA_BITS];
        wire [DATA_BITS-1:0] value_3 = sum_value[DATA_BITS*3 +: DATA_BITS];
        wire signed [39:0] component_0 = {{(40-DATA_BITS){value_0[DATA_BITS-1]}}, value_0};
        wire signed [39:0] component_1 = {{(40-DATA_BITS){value_1[DATA_BITS-1]}}, value_1};
        wire signed [39:0] component_2 = {{(40-DATA_BITS){value_2[DATA_BITS-1]}}, value_2};
        wire signed [39:0] component_3 = {{(40-DATA_BITS){value_3[DATA_BITS-1]}}, value_3};

        assign sums_there = sum_valid && (sums_count == 3'd6);
        assign sums = {
            z_sums,
            y_sums[3*40-1:40], y_sums[39:0] - share_y,
            x_sums[3*40-1:40], x_sums[39:0] - share_x,
            g_sums[9*40-1:7*40], g_sums[6*40 +: 40] - share_z, g_sums[6*40-1:0]
        };

        always @(posedge clock) begin
            sum_valid <= result_g[0];
            sum_row <= result_row[2:0];
            sum_value <= result_value;
            if (sum_valid) begin
                sums_count <= (sums_count == 3'd6) ? 3'd0 : sums_count + 3'd1;
                case (sum_row)
                    3'd0: begin
                        g_sums[40*0 +: 40] <= component_1;
                        g_sums[40*3 +: 40] <= component_2;
                        g_sums[40*6 +: 40] <= component_0;
                        z_sums[40*0 +: 40] <= component_3;
                    end
                    3'd1: begin
                        g_sums[40*1 +: 40] <= component_0;
                        g_sums[40*4 +: 40] <= component_3;
                        g_sums[40*7 +: 40] <= component_1;
                        z_sums[40*1 +: 40] <= component_2;
                    end
                    3'd2: begin
                        g_sums[40*2 +: 40] <= component_3;
                        g_sums[40*5 +: 40] <= component_0;
                        g_sums[40*8 +: 40] <= component_2;
                        z_sums[40*2 +: 40] <= component_1;
                    end
                    3'd3: begin
                        share_z <= component_0;
                        share_x <= component_2;
                        share_y <= component_1;
                    end
                    3'd4: begin
                        x_sums[40*0 +: 40] <= component_2;
                        y_sums[40*0 +: 40] <= component_1;
                    end
                    3'd5: begin
                        x_sums[40*1 +: 40] <= component_3;
                        y_sums[40*1 +: 40] <= component_0;
                    end
                    default: begin
                        x_sums[40*2 +: 40] <= component_0;
                        y_sums[40*2 +: 40] <= component_3;
                    end
                endcase
            end
            if (reset) begin
                sum_valid <= 1'b0;
                sums_count <= 3'd0;
            end
        end

`ifdef SIMULATION
        // By the schedule a frame's sums are taken before the next ones come
        always @(posedge clock) begin
            if (!reset && sum_valid && sums_complete && !sums_take) begin
                $fdisplay(32'h80000002, "%m: sums have come while those before are not taken");
                $fatal(1);
            end
        end
`endif

        // ---- What is stored as it comes
        localparam [31:0] LENGTH = ELEMENTS;
        wire [31:0] row_wide = {{(32-ROW_WIDTH){1'b0}}, result_row};
        localparam [47:0] OTHER_BASES = {STORE_BASES[47:32] + RESIDUAL_BANK, STORE_BASES[31:16] + RESIDUAL_BANK,
            STORE_BASES[15:0] + RESIDUAL_BANK};
        wire [47:0] bases = residual_bank ? OTHER_BASES : STORE_BASES[47:0];
        reg [15:0] base;
        reg stored_valid;
        reg [OPERAND_WIDTH-1:0] stored_address;
        reg [4*DATA_BITS-1:0] stored_data;

        always @(*) begin
            base = STORE_BASES[63:48];
            if (result_kept[0]) begin
                base = bases[15:0];
            end
            if (result_kept[1]) begin
                base = bases[31:16];
            end
            if (result_kept[2]) begin
                base = bases[47:32];
            end
        end

        assign write_next = (result_kept != 4'd0);
        assign write_valid = stored_valid;
        assign write_address = stored_address;
        assign write_data = stored_data;
        assign g_valid = 3'd0;
        assign g_component = {COMPONENT_WIDTH{1'b0}};
        assign g = {DATA_BITS{1'b0}};
        assign g_last = 1'b0;

        always @(posedge clock) begin
            stored_valid <= write_next;
            stored_address <= base[OPERAND_WIDTH-1:0] + row_wide[OPERAND_WIDTH-1:0];
            stored_data <= result_value;
            if (reset) begin
                stored_valid <= 1'b0;
            end
        end

        wire _unused = &{1'b0, result_g, row_wide, base, bank, LENGTH, STORE_IN_BANK, ROM_DIR == "",
            ROM_NAME == ""};
    end else begin : gen_taxels
        sptfra_coefficients #(
            .ELEMENTS      (ELEMENTS),
            .DATA_BITS     (DATA_BITS),
            .OPERAND_DEPTH (OPERAND_DEPTH),
            .STORE_BASES   (STORE_BASES),
            .STORE_IN_BANK (STORE_IN_BANK),
            .ROM_DIR       (ROM_DIR),
            .ROM_NAME      (ROM_NAME)
        ) coefficients (
            .clock          (clock),
            .reset          (reset),
            .result_partial (result_kept[2:0]),
            .result_g       (result_g),
            .result_row     (result_row),
            .result_value   (result_value),
            .bank           (bank),
            .write_next     (write_next),
            .write_valid    (write_valid),
            .write_address  (write_address),
            .write_data     (write_data),
            .g_valid        (g_valid),
            .g_component    (g_component),
            .g              (g),
            .sums_there     (sums_there),
            .sums           (sums)
        );

        assign g_last = sums_there;
        // Here nothing is left of the stress
        wire _unused = &{1'b0, result_kept[3], residual_bank, RESIDUAL_BANK};

`ifdef SIMULATION
        // By the schedule a frame's sums are taken before the next ones grow
        always @(posedge clock) begin
            if (!reset && (g_valid != 3'd0) && sums_complete && !sums_take) begin
                $fdisplay(32'h80000002, "%m: sums have come while those before are not taken");
                $fatal(1);
            end
        end
`endif
    end

endmodule

`default_nettype wire
